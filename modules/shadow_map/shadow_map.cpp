#include "modules/shadow_map/shadow_map.h"

#include "modules/core/error.h"
#include "modules/shadows/mask.h"

#include "shadow_map/shadow_map_shared.h"

namespace gnomon {

namespace {

/// "hard" is 0, "3x3" is 3.
uint32_t get_filter_width(const PropertyValues &p_properties) {
	const std::string &filter = std::get<std::string>(p_properties.at("shadow_map_filter"));
	return filter == "hard" ? 0 : static_cast<uint32_t>(filter[0] - '0');
}

} // namespace

void ShadowMap::get_light_properties(PropertyList &r_list) const {
	r_list.add({ "shadow_map_size", PropertyType::INT, int64_t(1024), "16,8192,16",
			"Width and height of each map. Larger maps have finer edges and cost memory.", "px",
			"Shadow map" });
	r_list.add({ "shadow_map_filter", PropertyType::ENUM, {}, "hard,2x2,3x3,5x5,7x7",
			"Texels that are averaged for each pixel. More blur the edge, blind to the light's "
			"size.",
			"", "Shadow map" });
}

void ShadowMap::get_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
		const PropertyValues &p_properties, std::vector<LightView> &r_views) const {
	const uint32_t size_px =
			static_cast<uint32_t>(std::get<int64_t>(p_properties.at("shadow_map_size")));
	const uint32_t border_px = get_filter_width(p_properties) / 2 + 1;
	r_views = build_light_views(p_light, p_scene, size_px, border_px);
}

void ShadowMap::plan(const Inputs &p_inputs, TechniquePlan &r_plan) {
	maps.plan(p_inputs, KeptViews::Reads::OWN_VIEW, r_plan);
}

void ShadowMap::at_light_view(RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_view_index) {
	maps.add_view(r_graph, p_inputs, p_view_index);
}

RGTexture ShadowMap::resolve(RenderGraph &r_graph, const Inputs &p_inputs) {
	if (maps.is_all_empty()) {
		return add_constant_mask(r_graph, p_inputs.size_px, 1.0f);
	}
	ComputePipelineDesc desc = { "shadow_map resolve", "shadow_map/resolve.comp",
		{ { SHADOW_MAP_CONSTANT_FILTER_WIDTH, get_filter_width(p_inputs.properties) } } };
	const PipelineRID pipeline = p_inputs.device.get_compute_pipeline(desc);
	const RGTexture mask = create_mask(r_graph, p_inputs.size_px);
	std::vector<PassBinding> bindings = make_map_resolve_bindings(r_graph, p_inputs);
	bindings.push_back(PassBinding::read(SHADOW_MAP_BINDING_MAP, maps.import(r_graph)));
	bindings.push_back(PassBinding::write(SHADOW_MAP_BINDING_MASK, mask));
	const shader::ShadowMapPush push = { maps.get_empty_views(), 0, 1, 0 };
	add_compute_pass(r_graph, "resolve", pipeline, bindings, p_inputs.size_px, push);
	return mask;
}

void ShadowMap::get_debug_views(std::vector<DebugView> &r_views) const {
	if (maps.get_imported()) {
		r_views.push_back({ "map", maps.get_imported() });
		r_views.back().is_light_depth = true;
	}
}

std::vector<std::string> ShadowMap::get_shader_files() const {
	return { "shadow_map/resolve.comp" };
}

} // namespace gnomon
