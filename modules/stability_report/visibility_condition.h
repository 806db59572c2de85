#pragma once

#include "modules/error_report/report.h"
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

/// Traces 256 rays a point and perturbation, with neither GPU nor Embree. For a few dozen points.
VisibilityCondition compute_visibility_condition(const SceneSnapshot &p_scene,
		const LightSnapshot &p_light, std::span<const ConditionPoint> p_points);

} // namespace gnomon
