#pragma once

#include "modules/shadow_planar/receiver_planes.h"
#include "modules/shadows/shadow_technique.h"

namespace gnomon {

/// Planar shadows: casters are projected along the rays from the light's centre onto the planes
/// that the scene declares, and drawn there (Blinn 1988). Hard shadows, exact on those planes.
/// Surfaces that are not declared planar receive no shadow.
///
/// The projection is composed in double precision, camera-relative, and ends in the camera's clip
/// space. Planes are moved towards the light, as receivers are.
class ShadowPlanar : public ShadowTechnique {
public:
	void get_light_properties(PropertyList &r_list) const override;
	void get_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
			const PropertyValues &p_properties, std::vector<LightView> &r_views) const override;
	void plan(const Inputs &p_inputs, TechniquePlan &r_plan) override;
	RGTexture resolve(RenderGraph &r_graph, const Inputs &p_inputs) override;
	std::vector<std::string> get_shader_files() const override;

private:
	// Of this frame.
	ReceiverPlanes receivers;
	std::vector<uint32_t> casters; // instance indices
};

} // namespace gnomon
