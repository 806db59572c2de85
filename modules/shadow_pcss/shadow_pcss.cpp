#include "modules/shadow_pcss/shadow_pcss.h"

#include "modules/core/text.h"
#include "modules/shadow_pcss/cascades.h"
#include "modules/shadows/mask.h"
#include "modules/shadows/nearest_caster.h"

#include "shadow_pcss/shadow_pcss_shared.h"

namespace gnomon {

void ShadowPcss::get_light_properties(PropertyList &r_list) const {
	r_list.add({ "pcss_taps", PropertyType::INT, int64_t(32), "4,256,1",
			"Taps of the blocker search, and as many of the filter. Few make noise, many cost "
			"time.",
			"", "PCSS" });
	add_size_property(r_list, "PCSS");
	r_list.add({ "pcss_cascades", PropertyType::INT, int64_t(1), "1,4,1",
			"Maps of a directional light, nested around what the camera sees up to a distance "
			"each. "
			"More have finer edges near the camera in large worlds, and cost time and memory.",
			"", "PCSS" });
}

void ShadowPcss::get_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
		const PropertyValues &p_properties, std::vector<LightView> &r_views) const {
	DepthMapTechnique::get_light_views(p_light, p_scene, p_properties, r_views);
	const auto count = read_count(p_properties, "pcss_cascades");
	if (p_light.type == LightType::DIRECTIONAL && count > 1) {
		r_views = split_into_cascades(r_views.front(), p_scene, count, get_border_px(p_properties));
	}
}

void ShadowPcss::plan(const Inputs &p_inputs, TechniquePlan &r_plan) {
	DepthMapTechnique::plan(p_inputs, r_plan);
	if (!p_inputs.may_skip || !p_inputs.views.front().is_orthographic) {
		return;
	}
	// The last view was narrowed to what the camera sees, so it may be finer than some cascades.
	for (uint32_t view = 0; view + 1 < p_inputs.views.size(); ++view) {
		if (!is_finer(p_inputs.views[view], p_inputs.views.back())) {
			r_plan.skip_light_view(view, "no finer than the map of all that the camera sees");
		}
	}
}

ShadowLimits ShadowPcss::get_limits(const PropertyValues & /*p_properties*/) const {
	// A nearer caster makes the blocker search wider than its shadow, see the sweep near_caster in
	// doc/stability.md.
	return { .min_caster_distance_radii = 5 };
}

void ShadowPcss::get_quality_settings(
		const LightSnapshot & /*p_light*/, std::vector<QualitySetting> &r_settings) const {
	for (const int64_t taps : { 16, 32, 64 }) {
		r_settings.push_back({ text(taps, " taps"), { { "pcss_taps", taps } } });
	}
}

void ShadowPcss::filter(RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_empty_views,
		std::vector<PassBinding> p_bindings) {
	shader::ShadowPcssPush push = {};
	push.empty_views = p_empty_views;
	push.tap_count = read_count(p_inputs.properties, "pcss_taps");
	push.light_radius = p_inputs.light.get_disc_radius();
	for (uint32_t view = 0; view < p_inputs.views.size(); ++view) {
		push.nearest_w[view] = compute_nearest_w(p_inputs, view);
	}
	add_map_resolve_pass(r_graph, "resolve",
			p_inputs.device.get_compute_pipeline({ "pcss resolve", shader, {} }),
			std::move(p_bindings), p_inputs, make_push_bytes(push));
}

} // namespace gnomon
