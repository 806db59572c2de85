#pragma once

#include "modules/core/property.h"
#include "modules/scene/nodes.h"
#include "modules/scene/scene_snapshot.h"

#include <memory>

namespace gnomon {

/// The type and size that a scene's light gets for a measurement.
struct LightVariant {
	LightType type = LightType::SPOT;
	/// Radius R of the light in metres, 0..1e4. A directional light gets the apparent diameter of a
	/// disc of radius R at a distance of 1.5 S (S: scene size); R is then at most 1.5 S, which is
	/// 90 degrees. The lights of the benchmark scenes are at about that distance.
	double size_m = 0;
};

/// Returns the LightVariant::size_m that corresponds to the light's current size.
double compute_own_size(const Light3D &p_light, double p_scene_size_m);

/// Builds a snapshot of the scene with one light changed. If the type changes, the light is aimed
/// at the centre of the shadow casters' bounds, its range becomes unlimited, and its cone contains
/// their bounding sphere where possible. It keeps its position, except that a formerly directional
/// light is placed 1.5 S from that centre. p_properties override the light's properties, also its
/// size. The scene itself is restored before the function returns or throws. Throws an Error for a
/// property out of range, and if the type changes in a scene without casters.
std::shared_ptr<const SceneSnapshot> build_variant(const Scene &p_scene, const Camera3D &p_camera,
		Light3D &r_light, const LightVariant &p_variant, const PropertyValues &p_properties);

/// Returns the light with that name. An unknown name is a programming error.
const LightSnapshot &get_light(const SceneSnapshot &p_scene, const std::string &p_name);

/// Returns true if the light's disc, which faces the surface point p_position, is entirely above
/// the tangent plane of the surface there. Positions have one origin, such as the world's or the
/// camera's; they and the unit normal have the world's axes. For a directional light
/// p_light_position is ignored. In the matrix, ReportError::whole_light has only such pixels.
bool is_light_disc_above_horizon(const LightSnapshot &p_light, const glm::vec3 &p_light_position,
		const glm::vec3 &p_position, const glm::vec3 &p_normal);

} // namespace gnomon
