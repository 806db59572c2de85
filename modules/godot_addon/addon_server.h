#pragma once

#include "modules/godot_addon/addon_settings.h"
#include "modules/godot_addon/scenario_effect.h"
#include "modules/godot_addon/scene_reader.h"
#include "modules/godot_addon/stand_in_lights.h"

namespace gnomon {

/// Ties nodes, worlds and effects together: before each frame it reads the worlds that have lights
/// with a visible GnomonShadow3D, and hands them to their effects. Main thread only.
class AddonServer {
public:
	/// Where Godot draws with another renderer than Forward+, one message, and nothing after it.
	AddonServer();
	~AddonServer();
	AddonServer(const AddonServer &) = delete;
	AddonServer &operator=(const AddonServer &) = delete;

private:
	void before_draw();
	/// The lights with shadows of Gnomon, by the scenario of their world. r_tree: theirs.
	std::map<godot::RID, std::vector<ShadowNode *>> find_worlds(godot::SceneTree &r_tree);
	void update_worlds();
	/// Which lights shine through stand-ins, and which of those need Godot's shadow too.
	std::vector<NeededStandIn> choose_stand_ins(const ReadWorld &p_world, bool p_has_failed) const;
	/// Makes room for the masks of a frame, on the render thread.
	void reserve(glm::uvec2 p_size_px, uint32_t p_mask_count);
	/// On the render thread.
	void clear_render_side();

	godot::RenderingServer server;
	godot::Callable on_frame;
	bool is_connected = false;
	bool is_editor = false;
	AddonSettings settings;
	bool has_warned = false; // of too many lights
	ReceiverMaterials receivers;
	StandInLights stand_ins;
	SceneReader reader{ receivers };
	std::shared_ptr<RenderSide> render_side = std::make_shared<RenderSide>();
	glm::uvec2 reserved_px = glm::uvec2(0); // for masks
	uint32_t reserved_count = 0;
	std::map<godot::RID, std::unique_ptr<ScenarioEffect>> effects; // by scenario
};

} // namespace gnomon
