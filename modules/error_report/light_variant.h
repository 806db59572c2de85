#pragma once

#include "modules/core/property.h"
#include "modules/scene/nodes.h"
#include "modules/scene/scene_snapshot.h"

#include <memory>

namespace gnomon {

/// A light of a scene as another type and with another size.
struct LightVariant {
	LightType type = LightType::SPOT;
	/// R in metres, 0..1e4. A directional light gets the apparent diameter that a disc of this
	/// radius has from 1.5 S away, as in the study's scenes; at most 1.5 S (90 degrees).
	double size_m = 0;
};

/// The size of a variant that leaves the light as it is.
double compute_own_size(const Light3D &p_light, double p_scene_size_m);

/// The scene with that one light changed. A light that changes its type stays where it is and looks
/// at the middle of the casters; one that was directional is 1.5 S away from it. p_properties
/// replace those of the light. The scene is as before when the function returns.
std::shared_ptr<const SceneSnapshot> build_variant(const Scene &p_scene, const Camera3D &p_camera,
		Light3D &r_light, const LightVariant &p_variant, const PropertyValues &p_properties);

/// The light of that name in a snapshot, which must be there.
const LightSnapshot &get_light(const SceneSnapshot &p_scene, const std::string &p_name);

/// True when no part of the light's disc is below the surface's own horizon: the population of
/// the study (doc/benchmarks.md, the study's scenes). Positions in one space; p_normal is unit.
bool sees_whole_disc(const LightSnapshot &p_light, const glm::vec3 &p_light_position,
		const glm::vec3 &p_position, const glm::vec3 &p_normal);

} // namespace gnomon
