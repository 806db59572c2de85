#include "modules/shadow_pcss/shadow_pcss.h"

#include "modules/core/text.h"
#include "modules/shadows/mask.h"
#include "modules/shadows/nearest_caster.h"

#include "shadow_pcss/shadow_pcss_shared.h"

namespace gnomon {

void ShadowPcss::get_light_properties(PropertyList &r_list) const {
	r_list.add({ "pcss_taps", PropertyType::INT, int64_t(32), "4,256,1",
			"Taps of the blocker search, and as many of the filter. Few make noise, many cost "
			"time.",
			"", "PCSS" });
	r_list.add({ "pcss_map_size", PropertyType::INT, int64_t(1024), "16,8192,16",
			"Width and height of each map. Larger maps have finer edges and cost memory.", "px",
			"PCSS" });
}

ShadowLimits ShadowPcss::get_limits(const PropertyValues & /*p_properties*/) const {
	// Nearer, the search for blockers is wider than the shadows: sweep near_caster of
	// doc/stability.md.
	return { .least_caster_distance_radii = 5 };
}

void ShadowPcss::get_quality_settings(
		const LightSnapshot & /*p_light*/, std::vector<QualitySetting> &r_settings) const {
	for (const int64_t taps : { 16, 32, 64 }) {
		r_settings.push_back({ text(taps, " taps"), { { "pcss_taps", taps } } });
	}
}

void ShadowPcss::get_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
		const PropertyValues &p_properties, std::vector<LightView> &r_views) const {
	const uint32_t size_px =
			static_cast<uint32_t>(std::get<int64_t>(p_properties.at("pcss_map_size")));
	r_views = build_light_views(p_light, p_scene, size_px, 1);
}

void ShadowPcss::plan(const Inputs &p_inputs, TechniquePlan &r_plan) {
	maps.plan(p_inputs, KeptViews::Reads::ACROSS_VIEWS, r_plan);
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
	for (uint32_t view = 0; view < p_inputs.views.size(); ++view) {
		push.nearest_w[view] = compute_nearest_w(p_inputs, view);
	}
	add_compute_pass(r_graph, "resolve",
			p_inputs.device.get_compute_pipeline(
					{ "pcss resolve", "shadow_pcss/resolve.comp", {} }),
			bindings, p_inputs.size_px, push);
	return mask;
}

void ShadowPcss::get_debug_views(std::vector<DebugView> &r_views) const {
	if (maps.get_imported()) {
		r_views.push_back({ "map", maps.get_imported() });
		r_views.back().is_light_depth = true;
	}
}

std::vector<std::string> ShadowPcss::get_shader_files() const {
	return { "shadow_pcss/resolve.comp" };
}

} // namespace gnomon
