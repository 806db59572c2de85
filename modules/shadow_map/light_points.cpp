#include "modules/shadow_map/light_points.h"

#include <glm/gtc/constants.hpp>

#include <cmath>

namespace gnomon {

namespace {

constexpr double GOLDEN_ANGLE_RAD = 2.399963229728653; // pi (3 - sqrt 5)
// 1 / plastic number. With the golden ratio instead, the radius would correlate with the direction,
// which advances by the golden angle.
constexpr double RADIUS_STEP = 0.7548776662466927;

/// Point p_index of a Vogel disc of radius 1.
glm::dvec2 compute_vogel_point(uint32_t p_index, uint32_t p_count) {
	const double radius = std::sqrt((p_index + 0.5) / p_count);
	const double angle_rad = GOLDEN_ANGLE_RAD * p_index;
	return radius * glm::dvec2(std::cos(angle_rad), std::sin(angle_rad));
}

/// Radius, as a fraction of R, within which the fraction p_fraction of an omni light's points are:
/// inverts F(x) = 2/pi (asin x - x sqrt(1 - x^2)) by bisection.
double compute_ball_radius(double p_fraction) {
	double low = 0;
	double high = 1;
	for (int step = 0; step < 50; ++step) { // to within 2^-51
		const double x = 0.5 * (low + high);
		const double fraction = (std::asin(x) - x * std::sqrt(1 - x * x)) * 2 / glm::pi<double>();
		(fraction < p_fraction ? low : high) = x;
	}
	return 0.5 * (low + high);
}

/// Point p_index of an omni light of radius 1.
glm::dvec3 compute_ball_point(uint32_t p_index, uint32_t p_count) {
	// A Fibonacci sphere gives the direction. The radii are stratified in an independent order.
	const double z = 1 - 2 * (p_index + 0.5) / p_count;
	const double angle_rad = GOLDEN_ANGLE_RAD * p_index;
	const double fraction = std::fmod(0.5 + p_index * RADIUS_STEP, 1.0);
	const double ring = std::sqrt(std::max(0.0, 1 - z * z));
	return compute_ball_radius(fraction) *
			glm::dvec3(ring * std::cos(angle_rad), ring * std::sin(angle_rad), z);
}

} // namespace

LightSnapshot make_light_point(
		const LightSnapshot &p_light, uint32_t p_index, uint32_t p_count, double p_nearest_m) {
	LightSnapshot point = p_light;
	const double radius = p_light.get_disc_radius();
	const glm::dmat3 &axes = p_light.world_from_light;
	if (p_light.type == LightType::OMNI) {
		point.position_world += radius * compute_ball_point(p_index, p_count);
		return point;
	}
	const glm::dvec2 offset = radius * compute_vogel_point(p_index, p_count);
	if (p_light.type == LightType::SPOT) {
		point.position_world += axes[0] * offset.x + axes[1] * offset.y;
		const double MAX_CONE_RAD = 1.55; // below pi / 2, where the tangent is infinite
		const double tangent = std::tan(std::min(MAX_CONE_RAD, double(p_light.outer_cone_rad)));
		const double widened = tangent + radius / std::max({ p_nearest_m, radius, 1e-9 });
		point.outer_cone_rad = static_cast<float>(std::atan(widened));
		return point;
	}
	const glm::dvec3 back = glm::normalize(axes[2] + axes[0] * offset.x + axes[1] * offset.y);
	const glm::dvec3 right = glm::normalize(axes[0] - back * glm::dot(axes[0], back));
	point.world_from_light = glm::dmat3(right, glm::cross(back, right), back);
	return point;
}

double compute_nearest_distance_m(const LightSnapshot &p_light, const SceneSnapshot &p_scene) {
	double nearest_m = 1e30;
	for (const InstanceSnapshot &instance : p_scene.instances) {
		nearest_m =
				std::min(nearest_m, instance.bounds_world.compute_distance(p_light.position_world));
	}
	return nearest_m;
}

} // namespace gnomon
