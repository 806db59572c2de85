#include "modules/shadow_volume/shadow_volume.h"

#include "modules/core/text.h"
#include "modules/shadow_volume/volume_passes.h"
#include "modules/shadows/mask.h"

#include "shadow_volume/culling_shared.h"

namespace gnomon {

void ShadowVolume::get_light_properties(PropertyList &r_list) const {
	add_removed_volume_properties(id, r_list);
}

void ShadowVolume::get_settings(PropertyList &r_list) const {
	add_volume_settings(is_on_cpu, r_list);
}

void ShadowVolume::get_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
		const PropertyValues & /*p_properties*/, std::vector<LightView> &r_views) const {
	const uint32_t border_px = 1;
	r_views = build_light_views(p_light, p_scene, CULLING_MAP_SIZE_PX, border_px);
}

void ShadowVolume::plan(const Inputs &p_inputs, TechniquePlan &r_plan) {
	settings = read_volume_settings(is_on_cpu, p_inputs);
	casters = build_volume_casters(p_inputs, settings,
			culling.plan(p_inputs, settings.culling, list_casters(p_inputs, r_plan), r_plan));
	const size_t count = casters.casters.size();
	if (count > 0) {
		culling.report(r_plan);
	}
	const auto report = [&](size_t p_count, const char *p_what) {
		if (p_count > 0) {
			r_plan.run(text(p_what, ", casters: ", p_count));
		}
	};
	report(count - casters.z_fail_count, "volumes by z-pass");
	report(casters.z_fail_count, "volumes by z-fail");
	report(casters.robust_count, "robust volumes");
	report(casters.geometry_shader_count, "volumes made by a geometry shader");
	edges.plan(p_inputs, list_compute_casters(p_inputs, casters), !culling.decides_draws(p_inputs),
			r_plan);
	if (casters.skipped_caps_count > 0) {
		r_plan.skip(text("far caps of ", casters.skipped_caps_count, " casters"),
				"z-pass is safe: the camera's near plane is outside their volumes");
	}
	if (casters.offscreen_count > 0) {
		r_plan.skip(text("volumes of ", casters.offscreen_count, " casters"),
				"their shadows are outside the image");
	}
	if (casters.collapsed_count > 0) {
		r_plan.skip(text("volumes of ", casters.collapsed_count, " casters"),
				"their transform collapses them to a line or a point");
	}
	if (casters.group_count > 1) {
		r_plan.run(
				text("groups of casters, each with its own stencil count: ", casters.group_count));
	}
}

RGTexture ShadowVolume::resolve(RenderGraph &r_graph, const Inputs &p_inputs) {
	if (casters.casters.empty() && p_inputs.may_skip) {
		return add_constant_mask(r_graph, p_inputs.size_px, 1.0f);
	}
	const VolumeTargets targets = add_volume_receivers_pass(r_graph, p_inputs);
	if (!casters.casters.empty()) {
		add_volume_passes(r_graph, p_inputs, settings, casters,
				culling.add_passes(r_graph, p_inputs), targets, edges);
	}
	return targets.mask;
}

void ShadowVolume::get_debug_views(std::vector<DebugView> &r_views) const {
	culling.get_debug_views(r_views);
}

std::vector<std::string> ShadowVolume::get_shader_files() const {
	std::vector<std::string> files;
	for (const char *name : { "receivers.frag", "hidden.frag", "volumes.vert", "volumes.geom",
				 "sides.vert", "caps.vert", "corners.vert", "occluders.vert", "occluders.frag",
				 "occluder_edges.vert", "bounds.comp", "cull.comp" }) {
		files.push_back(text("shadow_volume/", name));
	}
	return files;
}

} // namespace gnomon
