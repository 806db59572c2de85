#pragma once

#include "modules/godot_addon/mesh_reader.h"
#include "modules/godot_addon/notices.h"
#include "modules/godot_addon/pose_reader.h"
#include "modules/godot_addon/receiver_reader.h"
#include "modules/godot_addon/scenario_frame.h"
#include "modules/godot_addon/shader_time.h"
#include "modules/godot_addon/shadow_materials.h"
#include "modules/godot_addon/unculled_nodes.h"
#include "modules/godot_addon/unknown_objects.h"
#include "modules/godot_addon/view_visibility.h"

#include <span>

namespace gnomon {

/// A world of the RenderingServer as it was read for a frame.
struct ReadWorld {
	std::shared_ptr<ScenarioFrame> frame;
	std::vector<godot::Light3D> masked_lights; // in the order of frame->scene->lights
	std::vector<godot::Light3D> other_lights;  // visible lights without a mask
	WorldReceivers receivers;
	bool uses_godot_shadows = false; // a part of the world, such as fog, needs Godot's shadows
	/// How many objects that are no nodes a view drew in the last two frames.
	int64_t unknown_object_count = 0;
};

/// Reads the casters, receivers and lights of Godot's scenes. Main thread only.
class SceneReader {
public:
	SceneReader(ReceiverMaterials &r_materials, Notices &r_notices, ShaderTime &r_time) :
			receivers(r_materials), notices(r_notices), shader_time(r_time) {}
	/// p_scenario: a world of the RenderingServer. p_nodes: its lights' visible GnomonShadow3Ds.
	/// p_hidden_lights: lights that a query of the RenderingServer does not find, because their
	/// stand-ins replace them. Nodes that cannot be read are skipped, with one warning for each.
	ReadWorld read(godot::RID p_scenario, const godot::SceneTree &p_tree,
			std::span<ShadowNode *const> p_nodes, std::vector<godot::Light3D> p_hidden_lights);
	/// Call these once per frame, before and after the worlds are read.
	void begin_frame() { ++frame_number; }
	void end_frame();

private:
	void read_node(uint64_t p_id, SceneSnapshot &r_scene);
	/// Leaves out the faces that Godot's shadow of the last light in r_scene leaves out.
	void cull_faces(const ShadowNode &p_node, SceneSnapshot &r_scene);
	/// Adds the casters of GnomonServer.
	void read_server_casters(SceneSnapshot &r_scene);
	/// Sets bounds and scale of the details from p_first on, which belong to p_body. Godot chooses
	/// one level of detail for the whole node.
	void finish_details(const SceneBody &p_body, size_t p_first, const SceneSnapshot &p_scene);
	void read_mesh(const SceneBody &p_body, const godot::Mesh &p_mesh,
			const glm::dmat4 &p_world_from_mesh, SceneSnapshot &r_scene);
	/// Returns why a surface with such a material is drawn in a way that is not known; empty: it is
	/// known.
	static std::string find_unknown_motion(const SceneBody &p_body, const VertexMotion &p_motion);
	VertexMove read_move(const SceneBody &p_body, const Mesh &p_mesh, const ShadowSurface &p_shadow,
			const godot::Material &p_material, const glm::dmat4 &p_world_from_mesh);
	void read_grid_map(SceneBody p_body, const godot::GridMap &p_grid_map, SceneSnapshot &r_scene);
	/// p_meshes: a transform and a mesh in turn, as CSGShape3D returns them.
	void read_mesh_list(
			const SceneBody &p_body, const godot::Array &p_meshes, SceneSnapshot &r_scene);
	void read_multi_mesh(
			SceneBody p_body, const godot::MultiMesh &p_multi_mesh, SceneSnapshot &r_scene);
	/// Whether Godot draws a node whose mesh cannot be read into shadow maps.
	bool casts_in_godot(const godot::ObjectHandle &p_node);
	/// Adds only the box of a node whose mesh cannot be read, because it may receive shadows.
	void read_box(const SceneBody &p_body, const godot::GeometryInstance3D &p_instance,
			SceneSnapshot &r_scene);
	void read_light_node(const godot::Light3D &p_light);
	/// Returns whether masks can be made for any of the views.
	bool add_view_notices(const std::vector<ViewDetail> &p_views);
	/// p_text: the rest of the warning, after the node's path.
	void add_notice(const SceneBody &p_body, const std::string &p_text);
	static LightSnapshot read_light(const ShadowNode &p_node, double p_scene_size_m);

	ReceiverReader receivers;
	Notices &notices;
	ShaderTime &shader_time;
	ViewVisibility visibility;
	UnknownObjects unknown_objects;
	ReadWorld world;
	std::shared_ptr<ScenarioFrame> world_frame; // of `world`, while it is read
	std::unique_ptr<UnculledNodes> unculled;
	MeshReader meshes;
	FacingCasters facing{ meshes };
	PoseReader poses;
	ShadowMaterials materials;
	std::set<std::pair<uint64_t, std::string>> warned; // id of the node, warning
	struct CulledInstance {
		size_t instance = 0; // in the SceneSnapshot
		ShadowCulling culling = ShadowCulling::BACK;
	};
	std::vector<CulledInstance> culled;
	int64_t pending_count = 0;
	std::vector<InstanceDetail> details;
	uint64_t frame_number = 0;
};

} // namespace gnomon
