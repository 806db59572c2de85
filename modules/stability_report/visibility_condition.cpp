#include "modules/stability_report/visibility_condition.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace gnomon {

namespace {

const double GOLDEN_ANGLE_RAD = 2.39996322972865332;
// Displacements of the receiver as fractions of its distance to the light. The first is about the
// rounding error of a few float32 operations: 16 times half a unit in the last place. The second is
// large enough that 256 rays can resolve a gradual change of visibility.
const double ROUNDING_MOVE = 1e-6;
const double WIDE_MOVE = 1e-4;
// A cause explains an error if it amounts to at least this fraction of the error.
const double EXPLAINING_FRACTION = 0.5;

} // namespace

const char *get_name(ErrorCause p_cause) {
	static const char *const NAMES[] = { "method", "rounding", "reference_mask" };
	return NAMES[static_cast<int>(p_cause)];
}

DoubleVisibility::DoubleVisibility(const SceneSnapshot &p_scene, const LightSnapshot &p_light) :
		scene(p_scene), light(p_light) {
	for (const InstanceSnapshot &instance : p_scene.instances) {
		const glm::dmat4 node_from_world = glm::inverse(instance.world_from_node);
		// Flat casters have a thickness here (thicken_if_flat), so that a singular transform
		// collapses the caster to a line or a point, which hides nothing.
		const bool is_singular = !std::isfinite(
				node_from_world[0][0] + node_from_world[1][1] + node_from_world[2][2]);
		if (instance.casts_shadow && !is_singular) {
			bodies.push_back({ node_from_world, instance.bounds_world,
					std::make_unique<RayTree>(instance.get_posed_caster_mesh()) });
		}
	}
}

double DoubleVisibility::get_distance_m(const glm::dvec3 &p_position_world) const {
	return light.type == LightType::DIRECTIONAL
			? scene.scene_size_m
			: glm::length(light.position_world - p_position_world);
}

double DoubleVisibility::compute(const glm::dvec3 &p_position_world) const {
	const bool is_directional = light.type == LightType::DIRECTIONAL;
	const glm::dvec3 direction =
			is_directional ? -light.get_direction_world() : light.position_world - p_position_world;
	const glm::dvec3 axis = glm::normalize(direction);
	const glm::dvec3 other_axis =
			std::abs(axis.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
	const glm::dvec3 u = glm::normalize(glm::cross(axis, other_axis));
	const glm::dvec3 v = glm::cross(axis, u);
	int seen_count = 0;
	for (int sample = 0; sample < SAMPLE_COUNT; ++sample) {
		// Samples on a spiral: with a regular grid, an edge parallel to its rows would hide or
		// reveal a whole row at once.
		const double radius = light.get_disc_radius() * std::sqrt((sample + 0.5) / SAMPLE_COUNT);
		const double angle = sample * GOLDEN_ANGLE_RAD;
		const glm::dvec3 ray = direction + radius * (std::cos(angle) * u + std::sin(angle) * v);
		seen_count += is_blocked(p_position_world, ray, is_directional) ? 0 : 1;
	}
	return double(seen_count) / SAMPLE_COUNT;
}

bool DoubleVisibility::is_blocked(
		const glm::dvec3 &p_origin, const glm::dvec3 &p_ray, bool p_is_unbounded) const {
	const double end = p_is_unbounded ? 1e300 : 1.0; // in lengths of p_ray
	for (const Body &body : bodies) {
		if (!find_box_entry(body.bounds_world, p_origin, p_ray, 0.0, end)) {
			continue;
		}
		const glm::dvec3 origin = glm::dvec3(body.node_from_world * glm::dvec4(p_origin, 1.0));
		const glm::dvec3 ray = glm::dvec3(body.node_from_world * glm::dvec4(p_ray, 0.0));
		const std::optional<double> hit = body.tree->find_nearest(origin, ray);
		if (hit && *hit < end) {
			return true;
		}
	}
	return false;
}

VisibilityCondition compute_visibility_condition(const SceneSnapshot &p_scene,
		const LightSnapshot &p_light, std::span<const ConditionPoint> p_points) {
	VisibilityCondition mean;
	if (p_points.empty()) {
		return mean;
	}
	const DoubleVisibility tracer(p_scene, p_light);
	const double weight = 1.0 / double(p_points.size());
	for (const ConditionPoint &point : p_points) {
		const glm::dvec3 position = p_scene.camera.position_world + glm::dvec3(point.position);
		const double visibility = tracer.compute(position);
		const double distance = tracer.get_distance_m(position);
		double number = 0;
		double rounding = 0;
		for (const double move : { ROUNDING_MOVE, WIDE_MOVE }) {
			double change = 0;
			for (int direction = 0; direction < 6; ++direction) {
				glm::dvec3 moved = position;
				moved[direction / 2] += (direction % 2 == 0 ? move : -move) * distance;
				change = std::max(change, std::abs(tracer.compute(moved) - visibility));
			}
			number = std::max(number, change / move);
			rounding = move == ROUNDING_MOVE ? change : rounding;
		}
		mean.number += weight * number;
		mean.rounding += weight * rounding;
		mean.reference_error += weight * std::abs(visibility - point.reference);
		mean.error += weight * point.error;
	}
	mean.cause = mean.reference_error >= EXPLAINING_FRACTION * mean.error ? ErrorCause::REFERENCE
			: mean.rounding >= EXPLAINING_FRACTION * mean.error			  ? ErrorCause::ROUNDING
																		  : ErrorCause::METHOD;
	return mean;
}

} // namespace gnomon
