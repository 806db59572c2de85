#pragma once

#include "modules/scene/nodes.h"
#include "modules/scene/scene_snapshot.h"

#include <glm/glm.hpp>

namespace gnomon {

/// The viewport's camera. It rotates about a pivot in front of it and stays upright.
class OrbitCamera {
public:
	/// Takes position, direction, field of view and near plane from a camera of the scene. The
	/// pivot is placed at p_distance_m in front of it.
	void move_to_camera(const Camera3D &p_camera, double p_distance_m);
	/// Rotates about the pivot, by angles in radians.
	void orbit(double p_yaw_rad, double p_pitch_rad);
	/// Moves sideways and vertically, so that points at the pivot's distance move by p_heights in
	/// the image: x right, y down, in units of the image's height.
	void pan(const glm::dvec2 &p_heights);
	/// Multiplies the distance to the pivot by the factor; below 1 moves closer.
	void zoom(double p_factor);
	/// Rotates about the camera's own position, by angles in radians.
	void rotate_in_place(double p_yaw_rad, double p_pitch_rad);
	/// Moves along the camera's own axes: x right, y up, z back, in metres.
	void move(const glm::dvec3 &p_offset_m);
	/// Moves so that the whole bounds are visible in an image that is at least as wide as high.
	/// Empty bounds change nothing.
	void frame(const Bounds &p_bounds_world);
	/// Writes position, orientation, field of view and near plane into a camera whose parent is the
	/// root.
	void apply(Camera3D &r_camera) const;

	double get_distance_m() const { return distance_m; }
	/// Returns a counter that changes with every movement.
	uint64_t get_revision() const { return revision; }

private:
	glm::dmat3 compute_axes() const;
	glm::dvec3 compute_position() const;

	glm::dvec3 pivot_world = glm::dvec3(0.0);
	double distance_m = 5;
	double yaw_rad = 0;					   // 0 looks along -Z; positive turns left
	double pitch_rad = 0;				   // positive looks up
	float vertical_fov_rad = 0.785398163f; // 45 degrees
	float near_m = 0.05f;
	uint64_t revision = 0;
};

} // namespace gnomon
