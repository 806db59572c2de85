#include "modules/godot_addon/scenario_effect.h"

#include "modules/core/text.h"

namespace gnomon {

namespace {

using godot::Array;
using godot::RenderingServer;
using godot::Variant;

Array list_effects(const godot::Compositor &p_compositor) {
	Array effects;
	const Array found = p_compositor.get_compositor_effects();
	for (int64_t index = 0; index < found.get_size(); ++index) {
		const auto effect = godot::cast<godot::Resource>(
				godot::ObjectHandle(found.get_value(index).to_object()));
		if (effect) {
			effects.append(effect.get_rid());
		}
	}
	return effects;
}

} // namespace

ScenarioEffect::ScenarioEffect(godot::RID p_scenario, std::shared_ptr<RenderSide> p_render_side) :
		server(godot::find_singleton("RenderingServer")), scenario(p_scenario),
		render_side(std::move(p_render_side)) {
	make_effect = create_effect(RenderingServer::COMPOSITOR_EFFECT_CALLBACK_TYPE_PRE_OPAQUE,
			RenderingServer::COMPOSITOR_EFFECT_FLAG_ACCESS_RESOLVED_DEPTH, &RenderSide::make_masks);
	show_effect = create_effect(RenderingServer::COMPOSITOR_EFFECT_CALLBACK_TYPE_POST_TRANSPARENT,
			RenderingServer::COMPOSITOR_EFFECT_FLAG_ACCESS_RESOLVED_COLOR, &RenderSide::show_masks);
	compositor = server.compositor_create();
	Array effects;
	effects.append(make_effect);
	effects.append(show_effect);
	server.compositor_set_compositor_effects(compositor, effects);
}

ScenarioEffect::~ScenarioEffect() {
	for (const uint64_t id : extended_compositors) {
		if (const auto user_compositor = godot::cast<godot::Compositor>(
					godot::ObjectHandle(godot::get_instance(id)))) {
			server.compositor_set_compositor_effects(
					user_compositor.get_rid(), list_effects(user_compositor));
		}
	}
	server.free_rid(compositor); // the scenario then has none
	server.free_rid(make_effect);
	server.free_rid(show_effect);
}

godot::RID ScenarioEffect::create_effect(int64_t p_stage, int64_t p_flag,
		void (RenderSide::*p_run)(const ScenarioFrame &, const godot::Variant &)) {
	const godot::RID effect = server.compositor_effect_create();
	server.compositor_effect_set_callback(effect, p_stage,
			godot::Callable(
					[=, side = render_side, frames = slot](std::span<const Variant> p_arguments) {
						const std::shared_ptr<const ScenarioFrame> frame = frames->get();
						// Godot passes the effect's callback type and a RenderData.
						if (frame && p_arguments.size() == 2) {
							((*side).*p_run)(*frame, p_arguments[1]);
						}
					}));
	server.compositor_effect_set_flag(effect, p_flag, true);
	return effect;
}

void ScenarioEffect::add_to(const godot::Compositor &p_compositor) {
	Array effects = list_effects(p_compositor);
	effects.append(make_effect);
	effects.append(show_effect);
	server.compositor_set_compositor_effects(p_compositor.get_rid(), effects);
	extended_compositors.insert(godot::get_instance_id(p_compositor.get_object()));
}

void ScenarioEffect::update(
		std::shared_ptr<const ScenarioFrame> p_frame, const godot::SceneTree &p_tree) {
	const bool shows = !p_frame->shown_lights.empty();
	if (shows != is_show_effect_enabled) {
		server.compositor_effect_set_enabled(show_effect, shows);
		is_show_effect_enabled = shows;
	}
	slot->set(std::move(p_frame));
	// Godot's internal group with the WorldEnvironments of a world, of which Godot uses the first.
	// Without a Compositor there, the world gets our own one.
	const Array environments = p_tree.get_nodes_in_group(text("_world_compositor_", scenario.id));
	bool uses_own_compositor = true;
	if (environments.get_size() > 0) {
		const auto environment = godot::cast<godot::WorldEnvironment>(
				godot::ObjectHandle(environments.get_value(0).to_object()));
		const godot::Ref<godot::Compositor> user_compositor =
				environment ? environment.get_compositor() : godot::Ref<godot::Compositor>();
		if (user_compositor) {
			add_to(user_compositor);
			uses_own_compositor = false;
		}
	}
	if (uses_own_compositor) {
		server.scenario_set_compositor(scenario, compositor);
	}
	for_each_camera(
			p_tree, scenario, [&](const godot::Viewport &, const godot::Camera3D &p_camera) {
				if (const godot::Ref<godot::Compositor> user_compositor =
								p_camera.get_compositor()) {
					add_to(user_compositor);
				}
			});
}

} // namespace gnomon
