#pragma once

#include "modules/scene/scene_snapshot.h"

#include <godot_api.gen.h>

#include <memory>
#include <string>
#include <vector>

// Levels of detail (LOD). Godot draws meshes that are small in the image with fewer triangles.
// Casters are always the full meshes, which would wrongly shadow the reduced surface where the two
// deviate. So a pixel that shows a reduced mesh gets the depth of the full mesh, and its mask is
// that of the full scene.

namespace gnomon {

/// A reduced mesh in its rest pose, which uses the vertices of the full mesh, and Godot's measure
/// of its deviation from the full mesh.
struct DetailLevel {
	float edge_length_m = 0; // the deviation, in node space; ascending in DetailLevels
	std::shared_ptr<const Mesh> mesh;
};
using DetailLevels = std::vector<DetailLevel>;

/// The levels of detail of one instance of a SceneSnapshot, whose own mesh is the full one.
struct InstanceDetail {
	size_t instance = 0; // index in SceneSnapshot::instances
	std::shared_ptr<const DetailLevels> levels;
	Bounds bounds_world; // of the whole node
	float scale = 1;	 // the node's largest scale times its lod_bias
};

/// The settings of a viewport, by which Godot chooses levels of detail, and its size.
struct ViewDetail {
	godot::Transform3D camera; // transform of the viewport's camera
	float threshold_px = 1;	   // mesh_lod_threshold
	float resolution_scale = 1;
	glm::uvec2 size_px = glm::uvec2(0);			  // of the 3D image, after resolution_scale
	bool is_multisampled = false;				  // MSAA
	uint64_t viewport_id = 0;					  // of the node
	glm::dmat4 clip_from_world = glm::dmat4(1.0); // of the camera
	float half_diagonal_rad = 1;   // half the camera's angle of view across the image
	std::string orthogonal_camera; // its path; empty: the camera is not orthogonal
	/// Instances of the SceneSnapshot that the view does not draw, because of their visibility
	/// ranges; they cast no shadow in it.
	std::vector<size_t> hidden_instances;
	/// Billboards, which are turned to the view's camera, with their index in the SceneSnapshot.
	std::vector<std::pair<size_t, InstanceSnapshot>> billboards;
};

/// Returns the settings of each viewport that shows the world p_scenario.
std::vector<ViewDetail> find_view_details(const godot::SceneTree &p_tree, godot::RID p_scenario);

/// Returns the reduced mesh that Godot 4.6 draws for the instance; null: it draws the full one.
/// p_aspect: image width / height. p_threshold_px: see ViewDetail. p_width_px: image width before
/// resolution_scale.
std::shared_ptr<const Mesh> choose_detail_level(const InstanceDetail &p_detail,
		const CameraSnapshot &p_camera, float p_aspect, float p_threshold_px, float p_width_px);

/// Calls p_function with each viewport that shows the world and its camera.
template <typename Function>
void for_each_camera(const godot::SceneTree &p_tree, godot::RID p_scenario, Function p_function) {
	const godot::Array viewports = p_tree.get_nodes_in_group("_viewports"); // Godot's own group
	for (int64_t index = 0; index < viewports.get_size(); ++index) {
		const auto viewport = godot::cast<godot::Viewport>(
				godot::ObjectHandle(viewports.get_value(index).to_object()));
		const godot::Camera3D camera = viewport ? viewport.get_camera_3d() : godot::Camera3D();
		if (!camera) {
			continue;
		}
		const godot::Ref<godot::World3D> world = camera.get_world_3d();
		if (world && world.get_scenario() == p_scenario) {
			p_function(viewport, camera);
		}
	}
}

} // namespace gnomon
