#pragma once

#include "modules/core/property.h"
#include "modules/scene/nodes.h"
#include "modules/scene/scene_snapshot.h"

#include <memory>

namespace gnomon {

/// Another type and size for a light of a scene.
struct LightVariant {
	LightType type = LightType::SPOT;
	/// R in metres, 0..1e4. A directional light gets the apparent diameter of a disc of this radius
	/// at a distance of 1.5 S, as in the study's scenes; R is then at most 1.5 S (90 degrees).
	double size_m = 0;
};

/// The size of a variant that leaves the light as it is.
double compute_own_size(const Light3D &p_light, double p_scene_size_m);

/// A snapshot of the scene with one light changed. A light whose type changes keeps its position
/// and looks at the casters' centre; one that was directional is placed 1.5 S away from it.
/// p_properties replace those of the light. The scene itself is restored before return.
std::shared_ptr<const SceneSnapshot> build_variant(const Scene &p_scene, const Camera3D &p_camera,
		Light3D &r_light, const LightVariant &p_variant, const PropertyValues &p_properties);

/// The light with that name in a snapshot; it must exist.
const LightSnapshot &get_light(const SceneSnapshot &p_scene, const std::string &p_name);

/// True when no part of the light's disc is below the surface's horizon: the pixels that the study
/// measures (doc/benchmarks.md, the study's scenes). Positions in the same space; p_normal is unit.
bool sees_whole_disc(const LightSnapshot &p_light, const glm::vec3 &p_light_position,
		const glm::vec3 &p_position, const glm::vec3 &p_normal);

} // namespace gnomon
