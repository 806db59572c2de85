#include "modules/godot_addon/addon_server.h"

#include "modules/core/error.h"
#include "modules/core/log.h"

#include <algorithm>

namespace gnomon {

namespace {

const char FRAME_SIGNAL[] = "frame_pre_draw"; // of the RenderingServer, once a frame

/// Why no masks can be made; empty: they can.
std::string find_refusal(const godot::RenderingServer &p_server) {
	const std::string method = p_server.get_current_rendering_method().to_utf8();
	if (method != "forward_plus") {
		return text("the renderer is ", method, ". Set rendering/renderer/rendering_method to ",
				"forward_plus");
	}
	if (!p_server.get_rendering_device()) {
		return "Godot draws nothing here. Start it with a window, without --headless";
	}
	return {};
}

} // namespace

AddonServer::AddonServer() : server(godot::find_singleton("RenderingServer")) {
	const std::string refusal = find_refusal(server);
	if (!refusal.empty()) {
		set_shadow_node_listener([refusal] {
			log_warning("Lights keep Godot's own shadows: ", refusal, ".");
			set_shadow_node_listener({}); // once
		});
		return;
	}
	is_editor = godot::Engine(godot::find_singleton("Engine")).is_editor_hint();
	on_frame = godot::Callable([this](auto) {
		try {
			before_draw();
		} catch (const std::exception &failure) { // Godot knows no exceptions
			log_error(describe_failure(failure));
		}
	});
	server.connect(FRAME_SIGNAL, on_frame, 0);
	is_connected = true;
}

AddonServer::~AddonServer() {
	set_shadow_node_listener({});
	if (is_connected) {
		server.disconnect(FRAME_SIGNAL, on_frame);
		effects.clear();
		clear_render_side();
	}
}

void AddonServer::clear_render_side() {
	server.call_on_render_thread(godot::Callable([side = render_side](auto) { side->clear(); }));
}

void AddonServer::before_draw() {
	const std::vector<ShadowNode *> nodes = get_shadow_nodes();
	for (ShadowNode *node : nodes) {
		const std::vector<ShadowNode *> &alive = get_shadow_nodes();
		if (std::find(alive.begin(), alive.end(), node) == alive.end()) {
			continue; // somebody's callback removed it
		}
		node->call_back();
		if (is_editor) {
			node->update_warnings();
		}
	}
	update_worlds();
}

void AddonServer::update_worlds() {
	std::map<godot::RID, std::vector<ShadowNode *>> worlds;
	std::set<void *> lights;
	godot::SceneTree tree;
	for (ShadowNode *node : get_shadow_nodes()) {
		const godot::Light3D light = node->find_light();
		if (!light || !node->get_node().is_visible_in_tree() ||
				(light.is_editor_only() && !is_editor) ||
				!lights.insert(light.get_owner()).second) {
			continue;
		}
		const godot::Ref<godot::World3D> world = light.get_world_3d();
		if (world) {
			worlds[world.get_scenario()].push_back(node);
			tree = godot::SceneTree(node->get_node().get_tree().get_owner());
		}
	}
	const size_t before = effects.size();
	std::erase_if(effects, [&](const auto &p_entry) { return !worlds.contains(p_entry.first); });
	if (before > 0 && worlds.empty()) {
		clear_render_side();
	}
	reader.begin_frame();
	for (const auto &[scenario, nodes] : worlds) {
		std::unique_ptr<ScenarioEffect> &effect = effects[scenario];
		if (!effect) {
			effect = std::make_unique<ScenarioEffect>(scenario, render_side);
		}
		effect->update(reader.read(scenario, tree, nodes), tree);
	}
	reader.end_frame();
}

} // namespace gnomon
