#include "modules/main/fly_camera.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

constexpr double MAX_PITCH_RAD = 1.55; // just below 90 degrees, where yaw is undefined
constexpr double FAST_FACTOR = 5.0;	   // speed with Shift, as a multiple of normal speed

} // namespace

FlyCamera::FlyCamera(const Camera3D &p_start, double p_speed_m_per_s) :
		speed_m_per_s(p_speed_m_per_s) {
	const glm::dmat4 world_from_camera = p_start.compute_world_from_node();
	position_world = glm::dvec3(world_from_camera[3]);
	const glm::dvec3 forward = -glm::normalize(glm::dvec3(world_from_camera[2]));
	yaw_rad = std::atan2(-forward.x, -forward.z);
	pitch_rad = std::clamp(std::asin(forward.y), -MAX_PITCH_RAD, MAX_PITCH_RAD);
}

glm::dmat3 FlyCamera::compute_axes() const {
	const glm::dvec3 back(std::sin(yaw_rad) * std::cos(pitch_rad), -std::sin(pitch_rad),
			std::cos(yaw_rad) * std::cos(pitch_rad));
	const glm::dvec3 right(std::cos(yaw_rad), 0.0, -std::sin(yaw_rad));
	return glm::dmat3(right, glm::cross(back, right), back);
}

void FlyCamera::move(const glm::dvec3 &p_direction, double p_seconds, bool p_is_fast) {
	position_world += compute_axes() * p_direction *
			(speed_m_per_s * p_seconds * (p_is_fast ? FAST_FACTOR : 1.0));
}

void FlyCamera::rotate(double p_yaw_rad, double p_pitch_rad) {
	yaw_rad += p_yaw_rad;
	pitch_rad = std::clamp(pitch_rad + p_pitch_rad, -MAX_PITCH_RAD, MAX_PITCH_RAD);
}

void FlyCamera::apply(Camera3D &r_camera) const {
	r_camera.parent_from_node = glm::dmat4(compute_axes());
	r_camera.parent_from_node[3] = glm::dvec4(position_world, 1.0);
}

} // namespace gnomon
