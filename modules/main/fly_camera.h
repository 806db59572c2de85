#pragma once

#include "modules/scene/nodes.h"

#include <glm/glm.hpp>

namespace gnomon {

/// A free-flying camera: it starts at a camera node and stays upright.
class FlyCamera {
public:
	/// p_speed_m: metres per second at normal speed.
	FlyCamera(const Camera3D &p_start, double p_speed_m);

	/// p_direction: x right, y up, z back, each in -1..1.
	void move(const glm::dvec3 &p_direction, double p_seconds, bool p_is_fast);
	/// Turns by angles in radians; pitch stays short of straight up and down.
	void turn(double p_yaw_rad, double p_pitch_rad);
	/// Writes position and orientation into a camera whose parent is the root.
	void apply(Camera3D &r_camera) const;

private:
	glm::dmat3 compute_axes() const;

	glm::dvec3 position_world;
	double yaw_rad = 0; // 0 looks along -Z; positive turns left
	double pitch_rad = 0;
	double speed_m;
};

} // namespace gnomon
