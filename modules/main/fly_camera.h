#pragma once

#include "modules/scene/nodes.h"

#include <glm/glm.hpp>

namespace gnomon {

/// A free-flying camera that starts at the pose of a camera node. Its right axis stays horizontal
/// (no roll).
class FlyCamera {
public:
	/// p_speed_m_per_s: metres per second at normal speed.
	FlyCamera(const Camera3D &p_start, double p_speed_m_per_s);

	/// Moves the camera along its own axes. p_direction: x right, y up, z back, each in -1..1.
	/// p_is_fast: moves 5 times as fast.
	void move(const glm::dvec3 &p_direction, double p_seconds, bool p_is_fast);
	/// Rotates by angles in radians. Yaw is positive to the left, pitch upwards. The resulting
	/// pitch is clamped to +-1.55 rad, just below straight up and down.
	void rotate(double p_yaw_rad, double p_pitch_rad);
	/// Writes position and orientation to a camera node, whose parent must be the root.
	void apply(Camera3D &r_camera) const;

private:
	/// Returns the camera's axes in world space as columns: right, up, back.
	glm::dmat3 compute_axes() const;

	glm::dvec3 position_world;
	double yaw_rad = 0; // 0 looks along -Z; positive turns left
	double pitch_rad = 0;
	double speed_m_per_s;
};

} // namespace gnomon
