#include "modules/shadow_map/views.h"

#include "modules/core/error.h"
#include "modules/shadow_map/light_points.h"
#include "modules/shadows/caster_pass.h"
#include "modules/shadows/mask.h"

#include "shadow_map/shadow_map_shared.h"

#include <algorithm>

namespace gnomon {

namespace {

uint32_t get_point_count(const LightSnapshot &p_light, const PropertyValues &p_properties) {
	// A light without size has a single point.
	return p_light.get_disc_radius() > 0.0f ? read_count(p_properties, "views_count") : 1;
}

} // namespace

void Views::get_light_properties(PropertyList &r_list) const {
	r_list.add({ "views_count", PropertyType::INT, int64_t(16), "1,1024,1",
			"Points of the light from which a hard shadow map is drawn each frame.", "", "Views" });
	r_list.add({ "views_map_size", PropertyType::INT, int64_t(1024), "16,8192,16",
			"Width and height of each map.", "px", "Views" });
}

void Views::get_quality_settings(
		const LightSnapshot & /*p_light*/, std::vector<QualitySetting> &r_settings) const {
	r_settings.push_back({ "16 views", { { "views_count", int64_t(16) } } });
	r_settings.push_back({ "64 views", { { "views_count", int64_t(64) } }, /*is_expensive=*/true });
}

void Views::get_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
		const PropertyValues &p_properties, std::vector<LightView> &r_views) const {
	const uint32_t size_px = read_count(p_properties, "views_map_size");
	const uint32_t count = get_point_count(p_light, p_properties);
	const double nearest_m = compute_nearest_distance_m(p_light, p_scene.scene);
	for (uint32_t index = 0; index < count; ++index) {
		const LightSnapshot point = make_light_point(p_light, index, count, nearest_m);
		const std::vector<LightView> views =
				build_light_views(point, p_scene, size_px, /*p_border_px=*/1);
		r_views.insert(r_views.end(), views.begin(), views.end());
	}
}

void Views::plan(const Inputs &p_inputs, TechniquePlan &r_plan) {
	const uint32_t count = get_point_count(p_inputs.light, p_inputs.properties);
	views_per_point = static_cast<uint32_t>(p_inputs.views.size()) / count;
	is_empty.assign(p_inputs.views.size(), false);
	for (uint32_t index = 0; index < p_inputs.views.size(); ++index) {
		if (p_inputs.may_skip && p_inputs.casters[index].instances.empty()) {
			is_empty[index] = true;
			r_plan.skip_light_view(index, "no casters");
		} else if (p_inputs.may_skip && !p_inputs.casters[index].has_receivers) {
			is_empty[index] = true;
			r_plan.skip_light_view(index, "the camera sees no receiver in it");
		}
	}
	is_all_empty = std::all_of(
			is_empty.begin(), is_empty.end(), [](bool p_is_view_empty) { return p_is_view_empty; });
}

// All passes are recorded here and not in the views' hooks: all points share one map, so the pass
// that reads a point's map must directly follow its depth passes.
RGTexture Views::resolve(RenderGraph &r_graph, const Inputs &p_inputs) {
	if (is_all_empty) {
		return add_constant_mask(r_graph, p_inputs.size_px, 1.0f);
	}
	const PipelineRID pipeline = p_inputs.device.get_compute_pipeline(
			{ "views accumulate", "shadow_map/accumulate.comp", {} });
	const RGTexture mask = create_tiled_mask(r_graph, p_inputs.size_px, Format::R32_SFLOAT);
	const RGTexture map = r_graph.create_texture({ "map of one light point", Format::D32_SFLOAT,
			p_inputs.views[0].size_px, views_per_point,
			TextureUsage::DEPTH_ATTACHMENT | TextureUsage::SAMPLED, true });
	const uint32_t count = static_cast<uint32_t>(p_inputs.views.size()) / views_per_point;
	const double nearest_m = compute_nearest_distance_m(p_inputs.light, p_inputs.scene);
	bool is_map_written = false;
	for (uint32_t point_index = 0; point_index < count; ++point_index) {
		shader::ShadowMapPush push = { .point_index = point_index, .point_count = count };
		std::vector<LightView> views;
		for (uint32_t layer = 0; layer < views_per_point; ++layer) {
			const uint32_t index = point_index * views_per_point + layer;
			views.push_back(p_inputs.views[index]);
			if (is_empty[index]) {
				push.empty_views |= 1u << layer;
			} else {
				add_depth_pass(r_graph, text("depth point ", point_index, " view ", layer),
						p_inputs, p_inputs.views[index], p_inputs.casters[index], map, layer);
				is_map_written = true;
			}
		}
		if (!is_map_written) {
			// No map has been drawn yet. It is bound although no texel is read, so it must exist.
			add_depth_pass(r_graph, "empty map", p_inputs, views[0], /*p_casters=*/{}, map,
					/*p_layer=*/0);
			is_map_written = true;
		}
		const LightSnapshot point = make_light_point(p_inputs.light, point_index, count, nearest_m);
		std::vector<PassBinding> bindings =
				make_map_resolve_bindings(r_graph, p_inputs, point, views);
		bindings.push_back(PassBinding::read(DEPTH_MAP_BINDING_MAP, map));
		bindings.push_back(
				PassBinding::write(DEPTH_MAP_BINDING_MASK, mask, PassBuilder::Content::UPDATE));
		add_map_resolve_pass(r_graph, text("accumulate point ", point_index), pipeline,
				std::move(bindings), p_inputs, make_push_bytes(push));
	}
	return mask;
}

std::vector<std::string> Views::get_shader_files() const {
	return { "shadow_map/accumulate.comp" };
}

} // namespace gnomon
