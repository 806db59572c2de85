#pragma once

#include "modules/scene/nodes.h"
#include "modules/scene/scene_snapshot.h"

#include <glm/glm.hpp>

namespace gnomon {

/// The viewport's camera: it turns about a point in front of it, and stays upright.
class OrbitCamera {
public:
	/// Where a camera of the scene is; it turns about a point that is so far away.
	void look_as(const Camera3D &p_camera, double p_distance_m);
	/// Radians.
	void orbit(double p_yaw_rad, double p_pitch_rad);
	/// Sideways, in heights of the image.
	void pan(const glm::dvec2 &p_heights);
	/// Nearer by factors below 1.
	void zoom(double p_factor);
	/// Turns without moving.
	void turn(double p_yaw_rad, double p_pitch_rad);
	/// Flies: x right, y up, z back, in metres.
	void move(const glm::dvec3 &p_way_m);
	/// Shows all of it.
	void frame(const Bounds &p_bounds_world);
	/// Writes position and field of view into a camera whose parent is the root.
	void apply(Camera3D &r_camera) const;

	double get_distance_m() const { return distance_m; }
	/// Counts movements.
	uint64_t get_revision() const { return revision; }

private:
	glm::dmat3 compute_axes() const;
	glm::dvec3 compute_position() const;

	glm::dvec3 pivot_world = glm::dvec3(0.0);
	double distance_m = 5;
	double yaw_rad = 0; // 0 looks along -Z; positive turns left
	double pitch_rad = 0;
	float vertical_fov_rad = 0.785398163f;
	float near_m = 0.05f;
	uint64_t revision = 0;
};

} // namespace gnomon
