#pragma once

#include "modules/godot_addon/view_shadows.h"

#include <map>
#include <memory>
#include <set>

namespace gnomon {

/// The effects of one world (a scenario of the RenderingServer): in each of its viewports one makes
/// masks before opaque objects are drawn, one shows them behind transparent ones. Main thread only.
///
/// They are in a compositor of our own, and where a WorldEnvironment or a camera has a Compositor,
/// behind that one's effects; no node or resource of the user changes.
class ScenarioEffect {
public:
	ScenarioEffect(godot::RID p_scenario, std::shared_ptr<RenderSide> p_render_side);
	~ScenarioEffect();
	ScenarioEffect(const ScenarioEffect &) = delete;
	ScenarioEffect &operator=(const ScenarioEffect &) = delete;

	/// What the frame about to be drawn needs. Puts the effects where they have to be.
	void update(std::shared_ptr<const ScenarioFrame> p_frame, const godot::SceneTree &p_tree);

private:
	godot::RID create_effect(int64_t p_stage, int64_t p_flag,
			void (RenderSide::*p_run)(const ScenarioFrame &, const godot::Variant &));
	void add_to(const godot::Compositor &p_compositor);

	godot::RenderingServer server;
	godot::RID scenario;
	std::shared_ptr<RenderSide> render_side;
	std::shared_ptr<ScenarioFrameSlot> slot = std::make_shared<ScenarioFrameSlot>();
	godot::RID make_effect;
	godot::RID show_effect;
	godot::RID compositor;
	bool is_shown = true;
	std::set<uint64_t> extended; // compositors of the user, by the resource's id
};

} // namespace gnomon
