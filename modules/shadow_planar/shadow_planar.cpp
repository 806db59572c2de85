#include "modules/shadow_planar/shadow_planar.h"

#include "modules/core/text.h"
#include "modules/shadow_planar/planar_passes.h"
#include "modules/shadows/caster_pass.h"
#include "modules/shadows/mask.h"

namespace gnomon {

void ShadowPlanar::get_light_properties(PropertyList & /*r_list*/) const {}

void ShadowPlanar::get_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
		const PropertyValues & /*p_properties*/, std::vector<LightView> &r_views) const {
	r_views = build_listing_views(p_light, p_scene);
}

void ShadowPlanar::plan(const Inputs &p_inputs, TechniquePlan &r_plan) {
	casters = list_casters(p_inputs, r_plan);
	receivers = find_receiver_planes(p_inputs.scene, p_inputs.light);
	const size_t other_count = p_inputs.scene.instances.size() - receivers.declared_count;
	if (receivers.declared_count == 0) {
		r_plan.skip("planar shadows", "no node has shadow_planar_receiver: set it on floors");
	} else if (!receivers.planes.empty()) {
		r_plan.run(text("planes: ", receivers.planes.size()));
	}
	if (other_count > 0) {
		r_plan.skip(text("shadows on ", other_count, " other meshes"),
				"planar shadows fall on declared planes only");
	}
	if (receivers.curved_count > 0) {
		r_plan.skip(
				text("shadows on ", receivers.curved_count, " declared meshes"), "they are curved");
	}
	if (receivers.skipped_count > 0) {
		r_plan.skip(text("shadows on ", receivers.skipped_count, " small planes"),
				"16 are drawn at most");
	}
}

RGTexture ShadowPlanar::resolve(RenderGraph &r_graph, const Inputs &p_inputs) {
	if ((casters.empty() || receivers.planes.empty()) && p_inputs.may_skip) {
		return add_constant_mask(r_graph, p_inputs.size_px, /*p_visibility=*/1.0f);
	}
	const PlanarTargets targets = add_lit_pass(r_graph, p_inputs);
	for (uint32_t index = 0; index < receivers.planes.size(); ++index) {
		add_plane_passes(r_graph, p_inputs, receivers.planes[index], index, casters, targets);
	}
	return targets.mask;
}

std::vector<std::string> ShadowPlanar::get_shader_files() const {
	return { "shadow_planar/lit.frag", "shadow_planar/plane.frag", "shadow_planar/flatten.vert",
		"shadow_planar/flatten.frag" };
}

} // namespace gnomon
