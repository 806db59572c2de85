#pragma once

#include "modules/godot_addon/scenario_effect.h"
#include "modules/godot_addon/scene_reader.h"

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
	void update_worlds();
	/// On the render thread.
	void clear_render_side();

	godot::RenderingServer server;
	godot::Callable on_frame;
	bool is_connected = false;
	bool is_editor = false;
	SceneReader reader;
	std::shared_ptr<RenderSide> render_side = std::make_shared<RenderSide>();
	std::map<godot::RID, std::unique_ptr<ScenarioEffect>> effects; // by scenario
};

} // namespace gnomon
