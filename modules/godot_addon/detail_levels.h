#pragma once

#include "modules/scene/scene_snapshot.h"

#include <godot_api.gen.h>

#include <memory>
#include <string>
#include <vector>

// Godot draws meshes that are small in the image with fewer triangles. Casters are the full ones,
// and those would shadow the simpler surfaces that they deviate from. So a pixel that shows one
// gets the depth of the full mesh, and its mask is that of the full scene.

namespace gnomon {

/// A simpler mesh of the same vertices, at rest, and its deviation from the full one as Godot
/// compares it.
struct DetailLevel {
	float edge_length_m = 0; // in the node's space; ascending in a list
	std::shared_ptr<const Mesh> mesh;
};
using DetailLevels = std::vector<DetailLevel>;

/// Of one instance of a snapshot, whose own mesh is the full one.
struct InstanceDetail {
	size_t instance = 0;
	std::shared_ptr<const DetailLevels> levels;
	Bounds bounds_world; // of the whole node
	float scale = 1;	 // of the node, times its lod_bias
};

/// What decides of a viewport which level it draws.
struct ViewDetail {
	godot::Transform3D camera; // of the viewport
	float threshold_px = 1;	   // mesh_lod_threshold
	float resolution_scale = 1;
	glm::uvec2 size_px = glm::uvec2(0); // of the image that is drawn in 3D
};

/// The cameras of all viewports that show a world, with their viewports' settings.
std::vector<ViewDetail> find_view_details(const godot::SceneTree &p_tree, godot::RID p_scenario);

/// The mesh that Godot 4.6 draws for the instance; null: the full one. p_width_px: of the image.
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
