#include "modules/shadows/camera_view.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

LightView make_camera_view(const CameraSnapshot &p_camera, glm::uvec2 p_size_px) {
	const double tangent = std::tan(0.5 * p_camera.vertical_fov_rad);
	const double aspect = double(p_size_px.x) / p_size_px.y;
	LightView view;
	const glm::dmat3 &axes = p_camera.world_from_camera;
	const glm::dmat3 rotation = glm::transpose(glm::dmat3(axes[0], -axes[1], -axes[2]));
	view.view_from_world = glm::dmat4(rotation);
	view.view_from_world[3] = glm::dvec4(-(rotation * p_camera.position_world), 1.0);
	view.half_extent = glm::vec2(tangent * aspect, tangent);
	view.near_m = p_camera.near_m;
	view.size_px = p_size_px;
	return view;
}

LightView make_shifted_camera_view(const CameraSnapshot &p_camera, glm::uvec2 p_size_px) {
	LightView view = make_camera_view(p_camera, p_size_px);
	view.half_extent *= 1.0f + glm::abs(p_camera.shift);
	return view;
}

glm::dmat4 compute_shift(const CameraSnapshot &p_camera) {
	glm::dmat4 shift(1.0); // of clip space, whose y points down
	shift[3] = glm::dvec4(-p_camera.shift.x, p_camera.shift.y, 0.0, 1.0);
	return shift;
}

shader::FrameConstants compute_frame_constants(const SceneSnapshot &p_scene, glm::uvec2 p_size_px) {
	return compute_frame_constants(p_scene, p_scene.compute_caster_bounds(), p_size_px);
}

shader::FrameConstants compute_frame_constants(
		const SceneSnapshot &p_scene, const Bounds &p_caster_bounds_world, glm::uvec2 p_size_px) {
	const CameraSnapshot &camera = p_scene.camera;
	const LightView view = make_camera_view(camera, p_size_px);
	shader::FrameConstants frame = {};
	frame.clip_from_camera_relative =
			glm::mat4(compute_shift(camera) * view.compute_clip_from_view() *
					glm::dmat4(glm::dmat3(view.view_from_world))); // the camera is the origin
	const glm::dmat3 &axes = camera.world_from_camera;
	frame.right_tangent = glm::vec4(glm::vec3(axes[0]) * view.half_extent.x,
			p_scene.has_far_sides ? FAR_SIDE_SINE : NO_FAR_SIDE);
	frame.up_tangent = glm::vec4(glm::vec3(axes[1]) * view.half_extent.y, 0.0f);
	frame.forward = glm::vec4(glm::vec3(-axes[2]), 0.0f) +
			camera.shift.x * glm::vec4(glm::vec3(frame.right_tangent), 0.0f) +
			camera.shift.y * frame.up_tangent;
	frame.size_px = p_size_px;
	frame.near_m = camera.near_m;
	frame.scene_size_m = static_cast<float>(p_scene.scene_size_m);
	const double pixel_size_per_m = 2.0 * view.half_extent.y / p_size_px.y;
	const double extent_m = std::max(p_scene.scene_size_m, p_caster_bounds_world.get_diagonal());
	frame.pixel_size_per_m = static_cast<float>(pixel_size_per_m);
	frame.receiver_offset_m = static_cast<float>(RECEIVER_OFFSET_ROUNDING * extent_m);
	frame.receiver_offset_per_m =
			static_cast<float>(RECEIVER_OFFSET_ROUNDING + RECEIVER_OFFSET_PX * pixel_size_per_m);
	frame.max_receiver_offset_m = static_cast<float>(MAX_RECEIVER_OFFSET * p_scene.scene_size_m);
	return frame;
}

glm::vec3 compute_position(const shader::FrameConstants &p_frame, glm::uvec2 p_size_px,
		glm::uvec2 p_pixel, float p_depth) {
	const glm::vec2 uv = (glm::vec2(p_pixel) + 0.5f) / glm::vec2(p_size_px);
	return p_frame.near_m / p_depth *
			(glm::vec3(p_frame.forward) + (2.0f * uv.x - 1.0f) * glm::vec3(p_frame.right_tangent) +
					(1.0f - 2.0f * uv.y) * glm::vec3(p_frame.up_tangent));
}

} // namespace gnomon
