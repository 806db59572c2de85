#include "modules/editor/orbit_camera.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

const double MAX_PITCH_RAD = 1.55; // just below a right angle, at which yaw is ambiguous
const double MIN_DISTANCE_M = 1e-4;
const double MAX_DISTANCE_M = 1e7;

} // namespace

glm::dmat3 OrbitCamera::compute_axes() const {
	const glm::dmat4 yaw_rotation = glm::rotate(glm::dmat4(1.0), yaw_rad, glm::dvec3(0, 1, 0));
	return glm::dmat3(glm::rotate(yaw_rotation, pitch_rad, glm::dvec3(1, 0, 0)));
}

glm::dvec3 OrbitCamera::compute_position() const {
	return pivot_world + compute_axes()[2] * distance_m;
}

void OrbitCamera::move_to_camera(const Camera3D &p_camera, double p_distance_m) {
	const glm::dmat4 world_from_camera = p_camera.compute_world_from_node();
	const glm::dvec3 back = glm::normalize(glm::dvec3(world_from_camera[2]));
	yaw_rad = std::atan2(back.x, back.z);
	pitch_rad =
			std::clamp(-std::asin(std::clamp(back.y, -1.0, 1.0)), -MAX_PITCH_RAD, MAX_PITCH_RAD);
	distance_m = std::clamp(p_distance_m, MIN_DISTANCE_M, MAX_DISTANCE_M);
	pivot_world = glm::dvec3(world_from_camera[3]) - compute_axes()[2] * distance_m;
	vertical_fov_rad = p_camera.vertical_fov_rad;
	near_m = p_camera.near_m;
	++revision;
}

void OrbitCamera::orbit(double p_yaw_rad, double p_pitch_rad) {
	yaw_rad += p_yaw_rad;
	pitch_rad = std::clamp(pitch_rad + p_pitch_rad, -MAX_PITCH_RAD, MAX_PITCH_RAD);
	++revision;
}

void OrbitCamera::rotate_in_place(double p_yaw_rad, double p_pitch_rad) {
	const glm::dvec3 position = compute_position();
	orbit(p_yaw_rad, p_pitch_rad);
	pivot_world = position - compute_axes()[2] * distance_m;
}

void OrbitCamera::pan(const glm::dvec2 &p_heights) {
	const double height_m = 2.0 * distance_m * std::tan(0.5 * double(vertical_fov_rad));
	const glm::dmat3 axes = compute_axes();
	pivot_world -= (axes[0] * p_heights.x - axes[1] * p_heights.y) * height_m;
	++revision;
}

void OrbitCamera::zoom(double p_factor) {
	distance_m = std::clamp(distance_m * p_factor, MIN_DISTANCE_M, MAX_DISTANCE_M);
	++revision;
}

void OrbitCamera::move(const glm::dvec3 &p_offset_m) {
	pivot_world += compute_axes() * p_offset_m;
	++revision;
}

void OrbitCamera::frame(const Bounds &p_bounds_world) {
	if (p_bounds_world.is_empty()) {
		return;
	}
	pivot_world = 0.5 * (p_bounds_world.minimum + p_bounds_world.maximum);
	const double radius_m = 0.5 * glm::length(p_bounds_world.maximum - p_bounds_world.minimum);
	// The second radius keeps small bounds well behind the near plane.
	distance_m = std::clamp(
			std::max(radius_m, 10.0 * double(near_m)) / std::sin(0.5 * double(vertical_fov_rad)),
			MIN_DISTANCE_M, MAX_DISTANCE_M);
	++revision;
}

void OrbitCamera::apply(Camera3D &r_camera) const {
	glm::dmat4 world_from_camera = glm::dmat4(compute_axes());
	world_from_camera[3] = glm::dvec4(compute_position(), 1.0);
	r_camera.parent_from_node = world_from_camera;
	r_camera.vertical_fov_rad = vertical_fov_rad;
	r_camera.near_m = near_m;
}

} // namespace gnomon
