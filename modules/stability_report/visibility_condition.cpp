#include "modules/stability_report/visibility_condition.h"

#include "modules/stability_report/double_visibility.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

// Relative moves of the receiver. The first is what a few operations in float32 round away, 16
// halves of the last bit; the second shows slopes that 256 rays cannot resolve otherwise.
const double ROUNDING_MOVE = 1e-6;
const double WIDE_MOVE = 1e-4;
// A cause explains an error when it makes at least this share of it.
const double EXPLAINING_SHARE = 0.5;

} // namespace

VisibilityCondition compute_visibility_condition(const SceneSnapshot &p_scene,
		const LightSnapshot &p_light, std::span<const ConditionPoint> p_points) {
	VisibilityCondition mean;
	if (p_points.empty()) {
		return mean;
	}
	const DoubleVisibility tracer(p_scene, p_light);
	const double share = 1.0 / double(p_points.size());
	for (const ConditionPoint &point : p_points) {
		const glm::dvec3 position = p_scene.camera.position_world + glm::dvec3(point.position);
		const double visibility = tracer.compute(position, point.normal);
		const double distance = tracer.get_distance_m(position);
		double number = 0;
		double rounding = 0;
		for (const double move : { ROUNDING_MOVE, WIDE_MOVE }) {
			double change = 0;
			for (int way = 0; way < 6; ++way) {
				glm::dvec3 moved = position;
				moved[way / 2] += (way % 2 == 0 ? move : -move) * distance;
				change = std::max(
						change, std::abs(tracer.compute(moved, point.normal) - visibility));
			}
			number = std::max(number, change / move);
			rounding = move == ROUNDING_MOVE ? change : rounding;
		}
		mean.number += share * number;
		mean.rounding += share * rounding;
		mean.truth_error += share * std::abs(visibility - point.truth);
		mean.error += share * point.error;
	}
	mean.cause = mean.truth_error >= EXPLAINING_SHARE * mean.error ? ErrorCause::TRUTH
			: mean.rounding >= EXPLAINING_SHARE * mean.error	   ? ErrorCause::ROUNDING
																   : ErrorCause::METHOD;
	return mean;
}

} // namespace gnomon
