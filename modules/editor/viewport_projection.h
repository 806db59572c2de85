#pragma once

#include "modules/editor/orbit_camera.h"

#include <imgui.h>

#include <optional>

namespace gnomon {

/// Converts between world space and window pixels within the viewport's image.
class ViewportProjection {
public:
	/// p_top_left, p_size: upper left corner and size of the viewport's image, in window pixels.
	ViewportProjection(const OrbitCamera &p_camera, ImVec2 p_top_left, ImVec2 p_size);

	/// Returns a point's position in window pixels; nothing if it is nearer than the near plane or
	/// behind the camera.
	std::optional<ImVec2> project(const glm::dvec3 &p_world) const;
	/// Whether a position in window pixels is inside the viewport.
	bool is_inside(const ImVec2 &p_point) const;
	/// Returns the size of a pixel in metres, perpendicular to the view axis, at a point's depth,
	/// or at the near plane if the point is nearer.
	double compute_metres_per_px(const glm::dvec3 &p_world) const;
	glm::dvec3 get_eye() const { return glm::dvec3(world_from_camera[3]); }
	/// Returns the world direction from the camera through a position in window pixels, scaled to
	/// unit depth.
	glm::dvec3 compute_direction(const ImVec2 &p_point) const;

private:
	glm::dvec2 top_left;
	glm::dvec2 size;
	glm::dmat4 world_from_camera = glm::dmat4(1.0);
	glm::dmat4 camera_from_world = glm::dmat4(1.0);
	double focal_px = 1; // focal length: size in pixels of 1 m at a depth of 1 m
	double near_m = 0.05;
};

} // namespace gnomon
