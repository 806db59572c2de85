#pragma once

#include "modules/godot_addon/addon_settings.h"
#include "modules/godot_addon/scenario_effect.h"
#include "modules/godot_addon/scene_reader.h"
#include "modules/godot_addon/stand_in_lights.h"

namespace gnomon {

/// The add-on's update before each frame: reads the worlds that have a light with a visible
/// GnomonShadow3D, and passes each to its ScenarioEffect. Main thread only.
class AddonServer {
public:
	/// If Godot does not draw with Forward+, or draws nothing (--headless), it only logs one
	/// warning, when the first GnomonShadow3D enters the scene tree.
	AddonServer();
	~AddonServer();
	AddonServer(const AddonServer &) = delete;
	AddonServer &operator=(const AddonServer &) = delete;

private:
	void before_draw();
	/// Returns one visible GnomonShadow3D per light whose shadow is enabled, by the scenario of
	/// their world, at most settings.most_lights for each. r_tree is set to their scene tree, if
	/// there are any.
	std::map<godot::RID, std::vector<ShadowNode *>> find_worlds(godot::SceneTree &r_tree);
	void update_worlds();
	/// Returns the lights that need a stand-in, and whether each needs Godot's shadow as well.
	/// p_has_failed: the masks of a view could not be made.
	std::vector<NeededStandIn> choose_stand_ins(const ReadWorld &p_world, bool p_has_failed) const;
	/// Whether the world has objects that are no nodes and keep Godot's shadow.
	bool has_unknown_objects(godot::RID p_scenario, const ReadWorld &p_world);
	/// Makes the render thread allocate at least this much.
	void reserve(const ReceiverSpace &p_space);
	/// Makes the render thread free all GPU resources of Gnomon.
	void clear_render_side();

	godot::RenderingServer server;
	godot::Callable on_frame;
	bool is_connected = false;
	bool is_editor = false;
	AddonSettings settings;
	bool has_warned = false; // has logged that a world has too many lights
	/// Worlds in which Godot has drawn objects that are no nodes.
	std::set<godot::RID> worlds_with_unknown;
	Notices notices;
	ReceiverMaterials receiver_materials{ notices };
	ShaderTime shader_time;
	StandInLights stand_ins; // replace lights of nodes on the RenderingServer
	SceneReader reader{ receiver_materials, notices, shader_time };
	std::shared_ptr<RenderSide> render_side = std::make_shared<RenderSide>();
	ReceiverSpace reserved;
	std::map<godot::RID, std::unique_ptr<ScenarioEffect>> effects; // by scenario
};

} // namespace gnomon
