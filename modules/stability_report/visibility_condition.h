#pragma once

#include "modules/mesh_tools/ray_tree.h"
#include "modules/scene/scene_snapshot.h"

#include <glm/glm.hpp>

#include <memory>
#include <span>
#include <vector>

namespace gnomon {

/// The cause of a technique's error, see VisibilityCondition.
enum class ErrorCause {
	METHOD,	   // the method itself: exact arithmetic would not reduce the error
	ROUNDING,  // ill-conditioned: rounding the receiver position to float32 changes v as much
	REFERENCE, // the float32 reference has an error of this size
};
/// Returns "method", "rounding" or "reference_mask".
const char *get_name(ErrorCause p_cause);

/// How sensitive visibility v is to rounding at some points, computed in double precision. All
/// values are means over the points.
struct VisibilityCondition {
	/// Condition number: change of v divided by the relative change of the receiver's position P,
	/// |dv| rho / |dP|, with rho the distance to the light (directional: S).
	double number = 0;
	double rounding = 0;		// change of v when P moves by a float32 rounding error
	double reference_error = 0; // |v in double - v of the reference|
	double error = 0;			// |v of the technique - v of the reference|
	ErrorCause cause = ErrorCause::METHOD;
};

/// Computes the visibility of one light in double precision on the CPU, with 256 rays per point. It
/// is slow: meant for telling rounding errors from errors of a method at few points, and for
/// references that float32 makes too inaccurate. As in the reference technique, the light is a disc
/// of its radius that faces the point. Unlike there, translucent casters count as opaque. Scene and
/// light must outlive this object.
class DoubleVisibility {
public:
	static constexpr int SAMPLE_COUNT = 256; // rays per point

	DoubleVisibility(const SceneSnapshot &p_scene, const LightSnapshot &p_light);

	/// Returns the distance to the light's centre in metres; for a directional light S.
	double get_distance_m(const glm::dvec3 &p_position_world) const;
	/// Returns the visible fraction of the light, 0..1, at a receiver's position, which is off its
	/// surface.
	double compute(const glm::dvec3 &p_position_world) const;

private:
	struct Body {
		glm::dmat4 node_from_world;
		Bounds bounds_world;
		std::unique_ptr<RayTree> tree;
	};
	/// Returns whether a caster is hit. The ray ends at p_origin + p_ray unless p_is_unbounded.
	bool is_blocked(const glm::dvec3 &p_origin, const glm::dvec3 &p_ray, bool p_is_unbounded) const;

	const SceneSnapshot &scene;
	const LightSnapshot &light;
	std::vector<Body> bodies;
};

/// A receiver point at which a technique has a large error.
struct ConditionPoint {
	glm::vec3 position = glm::vec3(0.0f); // camera-relative, metres, off its surface
	double reference = 0;				  // visibility of the reference technique (float32)
	double error = 0;					  // |visibility of the technique - reference|
};

/// Computes how sensitive visibility is to rounding, as the mean over the points. For each,
/// DoubleVisibility is evaluated at the point and at 12 displaced positions: meant for a few dozen
/// points. No points: all values are 0.
VisibilityCondition compute_visibility_condition(const SceneSnapshot &p_scene,
		const LightSnapshot &p_light, std::span<const ConditionPoint> p_points);

} // namespace gnomon
