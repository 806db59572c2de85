#pragma once

#include "modules/error_report/report.h"
#include "modules/mesh_tools/ray_tree.h"
#include "modules/scene/scene_snapshot.h"

#include <glm/glm.hpp>

#include <memory>
#include <span>
#include <vector>

namespace gnomon {

/// Visibility of one light in double precision, from 256 rays a point, with neither GPU nor Embree:
/// slow, for few points, to separate rounding from method. The light is the disc of its
/// radius that faces the point, as the reference has it, and the point is moved by RECEIVER_OFFSET.
/// Scene and light must live on.
class DoubleVisibility {
public:
	static constexpr int SAMPLE_COUNT = 256;

	DoubleVisibility(const SceneSnapshot &p_scene, const LightSnapshot &p_light);

	/// To the light's centre; directional: S.
	double get_distance_m(const glm::dvec3 &p_position_world) const;
	/// The share of the light that a point of a surface with that unit normal sees, 0..1.
	double compute(const glm::dvec3 &p_position_world, const glm::dvec3 &p_normal) const;

private:
	struct Body {
		glm::dmat4 node_from_world;
		Bounds bounds_world;
		std::unique_ptr<RayTree> tree;
	};
	bool is_blocked(const glm::dvec3 &p_origin, const glm::dvec3 &p_ray, bool p_is_endless) const;

	const SceneSnapshot &scene;
	const LightSnapshot &light;
	std::vector<Body> bodies;
};

/// A receiver whose visibility a technique got wrong.
struct ConditionPoint {
	glm::vec3 position = glm::vec3(0.0f); // camera-relative, metres
	glm::vec3 normal = glm::vec3(0.0f);	  // of the face, unit
	double reference = 0;				  // v of the reference, in float32
	double error = 0;					  // |v of the technique - reference|
};

/// Traces 256 rays a point and perturbation, with neither GPU nor Embree. For a few dozen points.
VisibilityCondition compute_visibility_condition(const SceneSnapshot &p_scene,
		const LightSnapshot &p_light, std::span<const ConditionPoint> p_points);

} // namespace gnomon
