#include "modules/shadow_map/shadow_map.h"

#include "modules/core/error.h"
#include "modules/renderer/caster_pass.h"
#include "modules/renderer/lighting.h"
#include "modules/renderer/map_resolve.h"

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

void ShadowMap::get_light_views(const LightSnapshot &p_light, const SceneSnapshot &p_scene,
		const PropertyValues &p_properties, std::vector<LightView> &r_views) const {
	const uint32_t size_px =
			static_cast<uint32_t>(std::get<int64_t>(p_properties.at("shadow_map_size")));
	const uint32_t border_px = get_filter_width(p_properties) / 2 + 1;
	r_views = build_light_views(p_light, p_scene, size_px, border_px);
}

void ShadowMap::plan(const Inputs &p_inputs, TechniquePlan &r_plan) {
	const uint32_t view_count = static_cast<uint32_t>(p_inputs.views.size());
	const TextureDesc desc = { "shadow map of " + p_inputs.light.name, Format::D32_SFLOAT,
		p_inputs.views[0].size_px, view_count,
		TextureUsage::DEPTH_ATTACHMENT | TextureUsage::SAMPLED };
	frame_map = {};
	empty_views = 0;
	has_content = bool(map) && map_desc == desc;
	if (!has_content) {
		drawn_hashes.assign(view_count, 0);
	}
	for (uint32_t index = 0; index < view_count; ++index) {
		const CasterList &casters = p_inputs.casters[index];
		if (p_inputs.may_leave_out && casters.instances.empty()) {
			empty_views |= 1u << index;
			drawn_hashes[index] = 0;
			r_plan.leave_out_light_view(index, "no casters");
		} else if (p_inputs.may_leave_out && p_inputs.may_keep &&
				drawn_hashes[index] == casters.content_hash) {
			r_plan.leave_out_light_view(index, "kept: neither the light nor a caster moved");
		}
	}
	const bool is_all_empty = empty_views == (1u << view_count) - 1;
	if (!has_content && !is_all_empty) {
		map.reset();
		map = OwnedTexture(p_inputs.device, p_inputs.device.create_texture(desc));
		map_desc = desc;
	}
}

RGTexture ShadowMap::import_map(RenderGraph &r_graph) {
	if (!frame_map) {
		frame_map = r_graph.import_texture(map.get(),
				has_content ? RenderGraph::ImportedContent::KEPT
							: RenderGraph::ImportedContent::NONE);
	}
	return frame_map;
}

void ShadowMap::at_light_view(RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_view_index) {
	const CasterList &casters = p_inputs.casters[p_view_index];
	add_depth_pass(r_graph, text("depth view ", p_view_index), p_inputs,
			p_inputs.views[p_view_index], casters, import_map(r_graph), p_view_index);
	drawn_hashes[p_view_index] = casters.content_hash;
}

RGTexture ShadowMap::resolve(RenderGraph &r_graph, const Inputs &p_inputs) {
	if (empty_views == (1u << p_inputs.views.size()) - 1) {
		return add_constant_mask(r_graph, p_inputs.size_px, 1.0f);
	}
	ComputePipelineDesc desc = { "shadow_map resolve", "shadow_map/resolve.comp",
		{ { SHADOW_MAP_CONSTANT_FILTER_WIDTH, get_filter_width(p_inputs.properties) } } };
	const PipelineRID pipeline = p_inputs.device.get_compute_pipeline(desc);
	const RGTexture mask = create_mask(r_graph, p_inputs.size_px);
	std::vector<PassBinding> bindings = make_map_resolve_bindings(r_graph, p_inputs);
	bindings.push_back(PassBinding::read(SHADOW_MAP_BINDING_MAP, import_map(r_graph)));
	bindings.push_back(PassBinding::write(SHADOW_MAP_BINDING_MASK, mask));
	const shader::ShadowMapPush push = { empty_views, 0, 1, 0 };
	add_compute_pass(r_graph, "resolve", pipeline, bindings, p_inputs.size_px, push);
	return mask;
}

void ShadowMap::get_debug_views(std::vector<DebugView> &r_views) const {
	if (frame_map) {
		r_views.push_back({ "map", frame_map, glm::vec2(0.0f, 1e-3f), 0 });
	}
}

std::vector<std::string> ShadowMap::get_shader_files() const {
	return { "shadow_map/resolve.comp" };
}

} // namespace gnomon
