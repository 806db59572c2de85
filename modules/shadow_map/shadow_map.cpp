#include "modules/shadow_map/shadow_map.h"

#include "modules/shadows/mask.h"

#include "shadow_map/shadow_map_shared.h"

namespace gnomon {

namespace {

/// Parses the filter width in texels: "hard" is 0, "3x3" is 3.
uint32_t get_filter_width(const PropertyValues &p_properties) {
	const std::string &filter = read_choice(p_properties, "shadow_map_filter");
	return filter == "hard" ? 0 : static_cast<uint32_t>(filter[0] - '0');
}

} // namespace

void ShadowMap::get_light_properties(PropertyList &r_list) const {
	add_size_property(r_list, "Shadow map");
	r_list.add({ "shadow_map_filter", PropertyType::ENUM, {}, "hard,2x2,3x3,5x5,7x7",
			"Texels that are averaged for each pixel. More blur the edge, blind to the light's "
			"size.",
			"", "Shadow map" });
}

uint32_t ShadowMap::get_border_px(const PropertyValues &p_properties) const {
	// Half the box, and a texel that its border covers in part.
	return get_filter_width(p_properties) / 2 + 1;
}

void ShadowMap::filter(RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_empty_views,
		std::vector<PassBinding> p_bindings) {
	const PipelineRID pipeline = p_inputs.device.get_compute_pipeline({ "shadow_map resolve",
			shader,
			{ { SHADOW_MAP_CONSTANT_FILTER_WIDTH, get_filter_width(p_inputs.properties) } } });
	const shader::ShadowMapPush push = { p_empty_views, /*point_index=*/0, /*point_count=*/1,
		/*padding=*/0 };
	add_map_resolve_pass(
			r_graph, "resolve", pipeline, std::move(p_bindings), p_inputs, make_push_bytes(push));
}

} // namespace gnomon
