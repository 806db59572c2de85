#include "modules/godot_addon/detail_levels.h"

#include <cmath>

namespace gnomon {

namespace {

/// Returns the size in pixels of the viewport's 3D image before its 3D scaling. The texture of a
/// window in content scale mode canvas_items has the size of the canvas, not of the 3D image.
glm::vec2 read_size(const godot::Viewport &p_viewport) {
	const auto window = godot::cast<godot::Window>(p_viewport);
	if (window &&
			window.get_content_scale_mode() == godot::Window::CONTENT_SCALE_MODE_CANVAS_ITEMS) {
		return glm::vec2(window.get_size());
	}
	const godot::Ref<godot::ViewportTexture> texture = p_viewport.get_texture();
	return { float(texture.get_width()), float(texture.get_height()) };
}

float compute_half_diagonal(const godot::Camera3D &p_camera, glm::vec2 p_size) {
	const float tangent = std::tan(0.5f * glm::radians(static_cast<float>(p_camera.get_fov())));
	const bool keeps_width = p_camera.get_keep_aspect_mode() == godot::Camera3D::KEEP_WIDTH;
	const glm::vec2 half = p_size * (tangent / std::max(keeps_width ? p_size.x : p_size.y, 1.0f));
	return std::atan(glm::length(half));
}

} // namespace

std::vector<ViewDetail> find_view_details(const godot::SceneTree &p_tree, godot::RID p_scenario) {
	std::vector<ViewDetail> details;
	for_each_camera(p_tree, p_scenario,
			[&](const godot::Viewport &p_viewport, const godot::Camera3D &p_camera) {
				const float scale = static_cast<float>(p_viewport.get_scaling_3d_scale());
				details.push_back({ p_camera.get_camera_transform(),
						static_cast<float>(p_viewport.get_mesh_lod_threshold()), scale,
						glm::uvec2(glm::ceil(read_size(p_viewport) * scale)),
						p_viewport.get_msaa_3d() != 0,
						godot::get_instance_id(p_viewport.get_object()),
						glm::dmat4(p_camera.get_camera_projection()) *
								glm::inverse(p_camera.get_camera_transform().to_matrix()),
						compute_half_diagonal(p_camera, read_size(p_viewport)),
						p_camera.get_projection() == godot::Camera3D::PROJECTION_ORTHOGONAL
								? p_camera.get_path().to_utf8()
								: std::string(),
						/*hidden_instances=*/{}, /*billboards=*/{} });
			});
	return details;
}

std::shared_ptr<const Mesh> choose_detail_level(const InstanceDetail &p_detail,
		const CameraSnapshot &p_camera, float p_aspect, float p_threshold_px, float p_width_px) {
	const double distance_m = p_detail.bounds_world.compute_distance(p_camera.position_world);
	if (p_threshold_px <= 0 || distance_m == 0) {
		return nullptr;
	}
	// Image width, in metres, at a distance of 1 m.
	const double width_per_m = 2.0 * std::tan(0.5 * p_camera.vertical_fov_rad) * p_aspect;
	std::shared_ptr<const Mesh> chosen;
	for (const DetailLevel &level : *p_detail.levels) {
		const double width_fraction =
				level.edge_length_m * p_detail.scale / (distance_m * width_per_m); // of the width
		if (width_fraction > p_threshold_px / p_width_px) {
			break;
		}
		chosen = level.mesh;
	}
	return chosen;
}

} // namespace gnomon
