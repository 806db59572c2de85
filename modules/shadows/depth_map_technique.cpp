#include "modules/shadows/depth_map_technique.h"

#include "modules/core/error.h"
#include "modules/shadows/caster_pass.h"
#include "modules/shadows/mask.h"

#include "shared/map_resolve_shared.h"

namespace gnomon {

void DepthMapTechnique::add_size_property(PropertyList &r_list, const std::string &p_group) const {
	r_list.add({ size_property, PropertyType::INT, int64_t(1024), "16,8192,16",
			"Width and height of each map. Larger maps have finer edges and cost memory.", "px",
			p_group });
}

void DepthMapTechnique::get_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
		const PropertyValues &p_properties, std::vector<LightView> &r_views) const {
	const auto size_px = read_count(p_properties, size_property);
	r_views = build_light_views(p_light, p_scene, size_px, get_border_px(p_properties));
}

void DepthMapTechnique::plan(const Inputs &p_inputs, TechniquePlan &r_plan) {
	const TextureDesc desc = { "depth map of " + p_inputs.light.name, Format::D32_SFLOAT,
		p_inputs.views[0].size_px, static_cast<uint32_t>(p_inputs.views.size()),
		TextureUsage::DEPTH_ATTACHMENT | TextureUsage::SAMPLED, /*is_array=*/true };
	frame_map = {};
	views.begin(p_inputs, filter_reach);
	if (views.may_free_maps()) {
		map.reset(); // not read in this frame
	}
	has_content = bool(map) && map_desc == desc;
	views.plan(p_inputs, r_plan, has_content);
	if (!has_content && !views.is_all_empty()) {
		map.reset(); // first, so that two maps never exist at once
		map = OwnedTexture(p_inputs.device, p_inputs.device.create_texture(desc));
		map_desc = desc;
	}
}

RGTexture DepthMapTechnique::import(RenderGraph &r_graph) {
	if (!frame_map) {
		frame_map = r_graph.import_texture(map.get(),
				has_content ? RenderGraph::ImportedContent::PRESERVED
							: RenderGraph::ImportedContent::NONE);
	}
	return frame_map;
}

void DepthMapTechnique::at_light_view(
		RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_view_index) {
	add_depth_pass(r_graph, text("depth view ", p_view_index), p_inputs,
			p_inputs.views[p_view_index], p_inputs.casters[p_view_index], import(r_graph),
			p_view_index);
	views.set_drawn(p_inputs, p_view_index);
}

RGTexture DepthMapTechnique::resolve(RenderGraph &r_graph, const Inputs &p_inputs) {
	if (is_all_empty()) {
		return add_constant_mask(r_graph, p_inputs.size_px, 1.0f);
	}
	const RGTexture mask = create_tiled_mask(r_graph, p_inputs.size_px);
	std::vector<PassBinding> bindings = make_map_resolve_bindings(r_graph, p_inputs);
	bindings.push_back(PassBinding::read(DEPTH_MAP_BINDING_MAP, import(r_graph)));
	bindings.push_back(
			PassBinding::write(DEPTH_MAP_BINDING_MASK, mask, PassBuilder::Content::UPDATE));
	filter(r_graph, p_inputs, views.get_empty_views(), std::move(bindings));
	return mask;
}

void DepthMapTechnique::get_debug_views(std::vector<DebugView> &r_views) const {
	if (frame_map) {
		r_views.push_back({ "map", frame_map });
		r_views.back().is_light_depth = true;
	}
}

} // namespace gnomon
