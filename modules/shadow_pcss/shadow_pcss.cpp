#include "modules/shadow_pcss/shadow_pcss.h"

#include "modules/core/text.h"
#include "modules/renderer/lighting.h"
#include "modules/renderer/map_resolve.h"

#include "shadow_pcss/shadow_pcss_shared.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

/// Distance along the view before which none of the box lies, as far as the view sees it.
double compute_nearest_distance_m(
		const LightView &p_view, const LightSnapshot &p_light, const Bounds &p_bounds) {
	const double along_m = p_view.compute_distance_range_m(p_bounds).x;
	if (p_view.is_orthographic) {
		return along_m;
	}
	// A box that reaches behind the light may still be far from it wherever the view looks: what is
	// so far away, and between the view's sides, has at least this distance along the view.
	const glm::dvec3 nearest =
			glm::clamp(p_light.position_world, p_bounds.minimum, p_bounds.maximum);
	const double straight_m = glm::distance(p_light.position_world, nearest);
	const double corner = std::sqrt(
			1.0 + glm::dot(glm::dvec2(p_view.half_extent), glm::dvec2(p_view.half_extent)));
	return std::max(along_m, straight_m / corner);
}

/// The greatest w (see LightViewConstants) that a caster has in any view: no blocker is nearer to
/// the light, so that none is searched farther out than it can reach.
float compute_nearest_w(const ShadowTechnique::Inputs &p_inputs) {
	double nearest_w = 0;
	for (size_t index = 0; index < p_inputs.views.size(); ++index) {
		const LightView &view = p_inputs.views[index];
		for (uint32_t caster : p_inputs.casters[index].instances) {
			const Bounds &bounds = p_inputs.scene.instances[caster].bounds_world;
			if (!view.may_see(bounds)) {
				continue; // listed only when nothing may be left out
			}
			const double distance_m = std::max(
					double(view.near_m), compute_nearest_distance_m(view, p_inputs.light, bounds));
			nearest_w = std::max(
					nearest_w, view.is_orthographic ? view.far_m - distance_m : 1.0 / distance_m);
		}
	}
	return static_cast<float>(nearest_w);
}

} // namespace

void ShadowPcss::get_light_properties(PropertyList &r_list) const {
	r_list.add({ "pcss_taps", PropertyType::INT, int64_t(32), "4,256,1",
			"Taps of the blocker search, and as many of the filter. Few make noise, many cost "
			"time.",
			"", "PCSS" });
	r_list.add({ "pcss_map_size", PropertyType::INT, int64_t(1024), "16,8192,16",
			"Width and height of each map. Larger maps have finer edges and cost memory.", "px",
			"PCSS" });
}

void ShadowPcss::get_quality_settings(
		const LightSnapshot & /*p_light*/, std::vector<QualitySetting> &r_settings) const {
	for (const int64_t taps : { 16, 32, 64 }) {
		r_settings.push_back({ text(taps, " taps"), { { "pcss_taps", taps } } });
	}
}

void ShadowPcss::get_light_views(const LightSnapshot &p_light, const SceneSnapshot &p_scene,
		const PropertyValues &p_properties, std::vector<LightView> &r_views) const {
	const uint32_t size_px =
			static_cast<uint32_t>(std::get<int64_t>(p_properties.at("pcss_map_size")));
	r_views = build_light_views(p_light, p_scene, size_px, 1);
}

void ShadowPcss::plan(const Inputs &p_inputs, TechniquePlan &r_plan) {
	maps.plan(p_inputs, r_plan);
}

void ShadowPcss::at_light_view(
		RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_view_index) {
	maps.add_view(r_graph, p_inputs, p_view_index);
}

RGTexture ShadowPcss::resolve(RenderGraph &r_graph, const Inputs &p_inputs) {
	if (maps.is_all_empty()) {
		return add_constant_mask(r_graph, p_inputs.size_px, 1.0f);
	}
	const RGTexture mask = create_mask(r_graph, p_inputs.size_px);
	std::vector<PassBinding> bindings = make_map_resolve_bindings(r_graph, p_inputs);
	bindings.push_back(PassBinding::read(SHADOW_PCSS_BINDING_MAP, maps.import(r_graph)));
	bindings.push_back(PassBinding::write(SHADOW_PCSS_BINDING_MASK, mask));
	shader::ShadowPcssPush push = {};
	push.empty_views = maps.get_empty_views();
	push.tap_count = static_cast<uint32_t>(std::get<int64_t>(p_inputs.properties.at("pcss_taps")));
	push.disc_radius = p_inputs.light.get_disc_radius();
	push.nearest_w = compute_nearest_w(p_inputs);
	add_compute_pass(r_graph, "resolve",
			p_inputs.device.get_compute_pipeline(
					{ "pcss resolve", "shadow_pcss/resolve.comp", {} }),
			bindings, p_inputs.size_px, push);
	return mask;
}

void ShadowPcss::get_debug_views(std::vector<DebugView> &r_views) const {
	if (maps.get_imported()) {
		r_views.push_back({ "map", maps.get_imported(), glm::vec2(0.0f, 1e-3f) });
	}
}

std::vector<std::string> ShadowPcss::get_shader_files() const {
	return { "shadow_pcss/resolve.comp" };
}

} // namespace gnomon
