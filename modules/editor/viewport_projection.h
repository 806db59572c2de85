#pragma once

#include "modules/editor/orbit_camera.h"

#include <imgui.h>

#include <optional>

namespace gnomon {

/// Projects world points into the viewport's image, in window pixels.
class ViewportProjection {
public:
	ViewportProjection(const OrbitCamera &p_camera, ImVec2 p_least, ImVec2 p_size);

	/// Returns nothing for a point behind the camera or nearer than its near plane.
	std::optional<ImVec2> project(const glm::dvec3 &p_world) const;
	bool is_inside(const ImVec2 &p_point) const;
	/// World size of a pixel at that point, metres per pixel perpendicular to the view axis.
	double compute_metres_per_px(const glm::dvec3 &p_world) const;
	glm::dvec3 get_eye() const { return glm::dvec3(world_from_camera[3]); }
	/// World direction from the camera through a pixel, scaled to unit depth.
	glm::dvec3 compute_direction(const ImVec2 &p_point) const;

private:
	glm::dvec2 least;
	glm::dvec2 size;
	glm::dmat4 world_from_camera = glm::dmat4(1.0);
	glm::dmat4 camera_from_world = glm::dmat4(1.0);
	double focal_px = 1;
	double near_m = 0.05;
};

} // namespace gnomon
