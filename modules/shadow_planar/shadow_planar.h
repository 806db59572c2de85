#pragma once

#include "modules/shadow_planar/receiver_planes.h"
#include "modules/shadows/shadow_technique.h"

namespace gnomon {

/// The oldest trick: casters are flattened onto the planes that the scene declares, along the rays
/// of the light's centre (Blinn 1988), and drawn there. Exact on those planes, hard, and nowhere
/// else: what is not declared to be flat has no shadow on it.
///
/// Spaces: the projection is composed in double, relative to the camera; drawn in its clip space.
/// Planes are moved by 5e-5 S towards the light, as receivers are.
class ShadowPlanar : public ShadowTechnique {
public:
	void get_light_properties(PropertyList &r_list) const override;
	void get_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
			const PropertyValues &p_properties, std::vector<LightView> &r_views) const override;
	void plan(const Inputs &p_inputs, TechniquePlan &r_plan) override;
	RGTexture resolve(RenderGraph &r_graph, const Inputs &p_inputs) override;
	std::vector<std::string> get_shader_files() const override;

private:
	// This frame.
	ReceiverPlanes receivers;
	std::vector<uint32_t> casters; // instances
};

} // namespace gnomon
