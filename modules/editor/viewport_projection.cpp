#include "modules/editor/viewport_projection.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

ViewportProjection::ViewportProjection(
		const OrbitCamera &p_camera, ImVec2 p_top_left, ImVec2 p_size) :
		top_left(p_top_left.x, p_top_left.y),
		size(p_size.x, p_size.y) {
	Camera3D camera;
	p_camera.apply(camera);
	world_from_camera = camera.parent_from_node;
	camera_from_world = glm::inverse(world_from_camera);
	focal_px = 0.5 * size.y / std::tan(0.5 * double(camera.vertical_fov_rad));
	near_m = double(camera.near_m);
}

std::optional<ImVec2> ViewportProjection::project(const glm::dvec3 &p_world) const {
	const glm::dvec3 position(camera_from_world * glm::dvec4(p_world, 1.0));
	if (-position.z < near_m) {
		return std::nullopt;
	}
	const glm::dvec2 px =
			top_left + 0.5 * size + glm::dvec2(position.x, -position.y) * (focal_px / -position.z);
	return ImVec2(float(px.x), float(px.y));
}

bool ViewportProjection::is_inside(const ImVec2 &p_point) const {
	const glm::dvec2 position = glm::dvec2(p_point.x, p_point.y) - top_left;
	return position.x >= 0.0 && position.y >= 0.0 && position.x < size.x && position.y < size.y;
}

double ViewportProjection::compute_metres_per_px(const glm::dvec3 &p_world) const {
	const glm::dvec3 position(camera_from_world * glm::dvec4(p_world, 1.0));
	return std::max(-position.z, near_m) / focal_px;
}

glm::dvec3 ViewportProjection::compute_direction(const ImVec2 &p_point) const {
	const glm::dvec2 from_centre = glm::dvec2(p_point.x, p_point.y) - top_left - 0.5 * size;
	return glm::dvec3(world_from_camera *
			glm::dvec4(from_centre.x / focal_px, -from_centre.y / focal_px, -1.0, 0.0));
}

} // namespace gnomon
