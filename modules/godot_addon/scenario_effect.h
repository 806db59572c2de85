#pragma once

#include "modules/godot_addon/view_shadows.h"

#include <map>
#include <memory>
#include <set>

namespace gnomon {

/// The two compositor effects of one world (a scenario of the RenderingServer). In each viewport,
/// one makes the masks before opaque objects are drawn, and the other draws the masks to be shown
/// over the image after transparent objects. Main thread only.
///
/// They are in a compositor of their own. If a WorldEnvironment or a camera has a Compositor, they
/// follow its effects on the RenderingServer. No node or resource of the user changes.
class ScenarioEffect {
public:
	ScenarioEffect(godot::RID p_scenario, std::shared_ptr<RenderSide> p_render_side);
	~ScenarioEffect();
	ScenarioEffect(const ScenarioEffect &) = delete;
	ScenarioEffect &operator=(const ScenarioEffect &) = delete;

	/// Sets the data of the frame about to be drawn, and adds the effects to its compositors.
	void update(std::shared_ptr<const ScenarioFrame> p_frame, const godot::SceneTree &p_tree);

private:
	godot::RID create_effect(int64_t p_stage, int64_t p_flag,
			void (RenderSide::*p_run)(const ScenarioFrame &, const godot::Variant &));
	/// Called in every frame, because a change by the user replaces the compositor's effects.
	void add_to(const godot::Compositor &p_compositor);

	godot::RenderingServer server;
	godot::RID scenario;
	std::shared_ptr<RenderSide> render_side;
	std::shared_ptr<ScenarioFrameSlot> slot = std::make_shared<ScenarioFrameSlot>();
	godot::RID make_effect;
	godot::RID show_effect;
	godot::RID compositor;
	bool is_show_effect_enabled = true;
	std::set<uint64_t> extended_compositors; // ids of the user's compositors with our effects
};

} // namespace gnomon
