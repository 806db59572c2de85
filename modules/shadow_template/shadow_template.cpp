#include "modules/shadow_template/shadow_template.h"

#include "modules/core/text.h"
#include "modules/shadows/caster_pass.h"
#include "modules/shadows/mask.h"

#include "shadow_template/shadow_template_shared.h"

namespace gnomon {

// Declares the properties that a light gets: for the inspector, the scene file, --set and the docs.
void ShadowTemplate::get_light_properties(PropertyList &r_list) const {
	r_list.add({ "template_map_size", PropertyType::INT, int64_t(1024), "16,8192,16",
			"Width and height of the map drawn from the light.", "px", "Template" });
	r_list.add({ "template_strength", PropertyType::FLOAT, 1.0, "0,1,0.01",
			"How dark a hidden point is: 0 = as if lit, 1 = no light.", "", "Template" });
}

// Returns the views to render from the light. The casters of each view are culled to it.
void ShadowTemplate::get_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
		const PropertyValues &p_properties, std::vector<LightView> &r_views) const {
	const auto size_px = read_count(p_properties, "template_map_size");
	r_views = build_light_views(p_light, p_scene, size_px, /*p_border_px=*/1);
}

// Called before any pass is recorded, to skip what this frame does not need. The template skips
// nothing and only drops the last frame's map.
void ShadowTemplate::plan(const Inputs & /*p_inputs*/, TechniquePlan & /*r_plan*/) {
	map = {};
}

// Called once per view: draws the depth of the casters that the light sees.
void ShadowTemplate::at_light_view(
		RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_view_index) {
	if (!map) {
		map = r_graph.create_texture({ "template map", Format::D32_SFLOAT,
				p_inputs.views[p_view_index].size_px, static_cast<uint32_t>(p_inputs.views.size()),
				TextureUsage::DEPTH_ATTACHMENT | TextureUsage::SAMPLED, /*is_array=*/true });
	}
	add_depth_pass(r_graph, text("depth view ", p_view_index), p_inputs,
			p_inputs.views[p_view_index], p_inputs.casters[p_view_index], map, p_view_index);
}

// Called once per frame and light: computes the visibility of every pixel.
RGTexture ShadowTemplate::resolve(RenderGraph &r_graph, const Inputs &p_inputs) {
	const PipelineRID pipeline = p_inputs.device.get_compute_pipeline(
			{ "template resolve", "shadow_template/resolve.comp", {} });
	const RGTexture mask = create_tiled_mask(r_graph, p_inputs.size_px);
	std::vector<PassBinding> bindings = make_map_resolve_bindings(r_graph, p_inputs);
	bindings.push_back(PassBinding::read(DEPTH_MAP_BINDING_MAP, map));
	bindings.push_back(
			PassBinding::write(DEPTH_MAP_BINDING_MASK, mask, PassBuilder::Content::UPDATE));
	const auto strength = read_float(p_inputs.properties, "template_strength");
	const shader::ShadowTemplatePush push = { strength, 0, 0, 0 };
	add_map_resolve_pass(
			r_graph, "resolve", pipeline, std::move(bindings), p_inputs, make_push_bytes(push));
	return mask;
}

void ShadowTemplate::get_debug_views(std::vector<DebugView> &r_views) const {
	if (map) {
		r_views.push_back({ "map", map });
		r_views.back().is_light_depth = true;
	}
}

std::vector<std::string> ShadowTemplate::get_shader_files() const {
	return { "shadow_template/resolve.comp" };
}

} // namespace gnomon
