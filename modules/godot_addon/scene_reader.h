#pragma once

#include "modules/godot_addon/grid_maps.h"
#include "modules/godot_addon/mesh_reader.h"
#include "modules/godot_addon/pose_reader.h"
#include "modules/godot_addon/receiver_reader.h"
#include "modules/godot_addon/scenario_frame.h"
#include "modules/godot_addon/shadow_materials.h"

#include <span>

namespace gnomon {

/// A world of the RenderingServer as it is in a frame.
struct ReadWorld {
	std::shared_ptr<ScenarioFrame> frame;
	std::vector<godot::Light3D> masked_lights; // those of frame->scene, in its order
	std::vector<godot::Light3D> other_lights;
	WorldReceivers receivers;
	bool has_godot_readers = false; // others of Godot's shadows, such as fog
};

/// Reads the casters and lights of Godot's scenes. Main thread only.
class SceneReader {
public:
	explicit SceneReader(ReceiverMaterials &r_materials) : receivers(r_materials) {}
	/// p_scenario: a world of the RenderingServer. p_nodes: of the lights in it that are visible.
	/// What cannot be read is skipped, with one warning that names the node.
	/// p_hidden_lights: whose own light the RenderingServer does not show.
	ReadWorld read(godot::RID p_scenario, const godot::SceneTree &p_tree,
			std::span<ShadowNode *const> p_nodes, std::vector<godot::Light3D> p_hidden_lights);
	/// Once a frame, before all worlds are read, and after that.
	void begin_frame() { ++frame_number; }
	void end_frame();

private:
	void read_node(uint64_t p_id, SceneSnapshot &r_scene);
	/// Of the body that details from p_first on belong to: Godot chooses one level for all of it.
	void finish_details(const SceneBody &p_body, size_t p_first, const SceneSnapshot &p_scene);
	void read_mesh(const SceneBody &p_body, const godot::Mesh &p_mesh,
			const glm::dmat4 &p_world_from_mesh, SceneSnapshot &r_scene);
	/// Pairs of a transform and a mesh, as GridMap and CSGShape3D have them.
	void read_mesh_list(
			const SceneBody &p_body, const godot::Array &p_meshes, SceneSnapshot &r_scene);
	void read_multi_mesh(
			const SceneBody &p_body, const godot::MultiMesh &p_multi_mesh, SceneSnapshot &r_scene);
	/// Its box alone: it may receive shadows.
	void read_unknown(const SceneBody &p_body, const godot::VisualInstance3D &p_instance,
			SceneSnapshot &r_scene);
	void read_light_node(const godot::Light3D &p_light);
	void warn_once(const SceneBody &p_body, const std::string &p_warning);
	static LightSnapshot read_light(const ShadowNode &p_node, double p_scene_size_m);

	ReceiverReader receivers;
	ReadWorld world;
	std::unique_ptr<GridMaps> grid_maps;
	MeshReader meshes;
	PoseReader poses;
	ShadowMaterials materials;
	std::set<std::pair<uint64_t, std::string>> warned; // id of the node, warning
	int64_t pending_count = 0;
	std::vector<InstanceDetail> details;
	uint64_t frame_number = 0;
};

} // namespace gnomon
