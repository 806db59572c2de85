#pragma once

#include "modules/scene/scene_snapshot.h"

#include <glm/glm.hpp>

#include <span>

namespace gnomon {

/// A receiver whose visibility a technique got wrong.
struct ConditionPoint {
	glm::vec3 position = glm::vec3(0.0f); // camera-relative, metres
	glm::vec3 normal = glm::vec3(0.0f);	  // of the face, unit
	double truth = 0;					  // v as the reference has it, in float32
	double error = 0;					  // |v of the technique - truth|
};

/// Whose fault an error is.
enum class ErrorCause {
	METHOD,	  // exact arithmetic would leave it
	ROUNDING, // the question itself changes as much when its input is rounded to float32
	TRUTH,	  // the reference in float32 is off by as much
};
/// "method", "rounding", "truth".
const char *get_cause_name(ErrorCause p_cause);

/// How sensitive visibility is at some points, in double precision: means over the points.
struct VisibilityCondition {
	/// Change of v over the relative change of the receiver's place that makes it: |dv| rho / |dP|,
	/// rho the distance to the light (directional: S).
	double number = 0;
	double rounding = 0;	// change of v when P moves by what float32 rounds away
	double truth_error = 0; // |v in double - v of the reference|
	double error = 0;		// of the technique
	ErrorCause cause = ErrorCause::METHOD;
};

/// Traces 256 rays a point and perturbation, with neither GPU nor Embree. For a few dozen points.
VisibilityCondition compute_visibility_condition(const SceneSnapshot &p_scene,
		const LightSnapshot &p_light, std::span<const ConditionPoint> p_points);

} // namespace gnomon
