#include "modules/godot_addon/addon_server.h"

#include "modules/core/error.h"
#include "modules/core/log.h"
#include "modules/godot_addon/addon_settings.h"
#include "modules/godot_addon/light_choice.h"
#include "modules/scene/cut_mesh.h"

#include "godot_addon/godot_addon_shared.h"

#include <algorithm>

namespace gnomon {

namespace {

// Of the outlines on one mesh. A tree of 107 cards, each with the leaves of a whole branch, has
// 6000 faces a card without such a limit, and its shadow takes 68 times as long.
const uint32_t MAX_OUTLINE_EDGES = 1 << 18;
const char FRAME_SIGNAL[] = "frame_pre_draw"; // emitted by the RenderingServer before each frame

/// Returns why no masks can be made, or an empty string if they can.
std::string find_unsupported_renderer(const godot::RenderingServer &p_server) {
	const std::string method = p_server.get_current_rendering_method().to_utf8();
	if (method != "forward_plus") {
		return text("the renderer is ", method, ". Set rendering/renderer/rendering_method to ",
				"forward_plus");
	}
	const std::string driver = p_server.get_current_rendering_driver_name().to_utf8();
	const bool is_untried = driver == "d3d12" || driver == "metal";
	if (is_untried && !read_addon_settings().allows_other_drivers) {
		return text("Godot draws with ", driver, ", and the add-on was only run with Vulkan. Set ",
				"rendering/rendering_device/driver.", driver == "d3d12" ? "windows" : "macos",
				" to vulkan, or turn rendering/gnomon/other_drivers on to try it");
	}
	if (!p_server.get_rendering_device()) {
		return "Godot draws nothing here. Start it with a window, without --headless";
	}
	return {};
}

} // namespace

AddonServer::AddonServer() : server(godot::find_singleton("RenderingServer")) {
	const std::string unsupported_reason = find_unsupported_renderer(server);
	if (!unsupported_reason.empty()) {
		set_shadow_node_listener([unsupported_reason] {
			log_warning("Lights keep Godot's own shadows: ", unsupported_reason, ".");
			set_shadow_node_listener({}); // warn only once
		});
		return;
	}
	set_outline_budget({ .edges_per_mesh = MAX_OUTLINE_EDGES });
	is_editor = godot::Engine(godot::find_singleton("Engine")).is_editor_hint();
	on_frame = godot::Callable([this](auto) {
		try {
			before_draw();
		} catch (const std::exception &failure) { // must not reach Godot
			log_error(describe_failure(failure));
		}
	});
	server.connect(FRAME_SIGNAL, on_frame, /*flags=*/0);
	is_connected = true;
	// When Godot quits, it frees a light's projector texture before the next frame: the stand-in,
	// which also refers to it, must be gone by then.
	set_last_shadow_node_listener([this] { stand_ins.clear(); });
}

AddonServer::~AddonServer() {
	set_shadow_node_listener({});
	set_last_shadow_node_listener({});
	if (is_connected) {
		server.disconnect(FRAME_SIGNAL, on_frame);
		effects.clear();
		clear_render_side();
	}
}

void AddonServer::clear_render_side() {
	reserved = {};
	server.call_on_render_thread(godot::Callable([side = render_side](auto) { side->clear(); }));
}

void AddonServer::before_draw() {
	const std::vector<ShadowNode *> nodes = get_shadow_nodes();
	for (ShadowNode *node : nodes) {
		const std::vector<ShadowNode *> &alive = get_shadow_nodes();
		if (std::find(alive.begin(), alive.end(), node) == alive.end()) {
			continue; // a callback of another node removed it
		}
		node->call_back();
		if (is_editor) {
			node->update_warnings();
		}
	}
	shader_time.update();
	update_worlds();
}

std::map<godot::RID, std::vector<ShadowNode *>> AddonServer::find_worlds(godot::SceneTree &r_tree) {
	std::map<godot::RID, std::vector<ShadowNode *>> worlds;
	std::set<void *> lights;
	for (ShadowNode *node : get_shadow_nodes()) {
		const godot::Light3D light = node->find_light();
		node->makes_mask = node->makes_mask && light && light.has_shadow();
		if (!light || !node->get_node().is_visible_in_tree() || !light.has_shadow() ||
				(light.is_editor_only() && !is_editor) ||
				!lights.insert(light.get_object()).second) {
			continue;
		}
		const godot::Ref<godot::World3D> world = light.get_world_3d();
		if (!world) {
			continue;
		}
		worlds[world.get_scenario()].push_back(node);
		r_tree = godot::SceneTree(node->get_node().get_tree().get_object());
	}
	for (auto &[scenario, nodes] : worlds) {
		if (nodes.size() <= settings.most_lights) {
			continue;
		}
		choose_lights(nodes, find_view_details(r_tree, scenario), settings.most_lights);
		for (size_t index = settings.most_lights; index < nodes.size(); ++index) {
			nodes[index]->makes_mask = false;
		}
		if (!std::exchange(has_warned, true)) {
			const size_t limit = RECEIVER_ROW_COUNT - 1;
			const std::string step = settings.most_lights < limit
					? "Raise rendering/gnomon/most_lights in the project's settings, at most " +
							std::to_string(limit) + "."
					: "This is the largest number: remove GnomonShadow3D nodes from lights that "
					  "need none.";
			log_warning("\"", nodes[settings.most_lights]->get_path(),
					"\" has no shadow of Gnomon: its world has ", nodes.size(),
					" lights with one, and the ", settings.most_lights,
					" that cover more of the view have it. ", step);
		}
		nodes.resize(settings.most_lights);
	}
	return worlds;
}

void AddonServer::update_worlds() {
	godot::SceneTree tree;
	std::map<godot::RID, std::vector<ShadowNode *>> worlds;
	settings = read_addon_settings();
	set_default_technique(settings.default_technique);
	if (settings.is_enabled) {
		worlds = find_worlds(tree);
	}
	const size_t before = effects.size();
	std::erase_if(effects, [&](const auto &p_entry) { return !worlds.contains(p_entry.first); });
	std::erase_if(worlds_with_unknown,
			[&](const godot::RID &p_scenario) { return !worlds.contains(p_scenario); });
	if (before > 0 && worlds.empty()) {
		clear_render_side();
	}
	const bool has_failed = render_side->take_failure();
	ReceiverSpace needed;
	// The editor draws only when something changes, so it could stay incomplete.
	const bool is_gradual = settings.is_compilation_gradual && !is_editor;
	receiver_materials.begin_frame(is_gradual ? 1 : ReceiverMaterials::UNLIMITED);
	reader.begin_frame();
	for (const auto &[scenario, nodes] : worlds) {
		ReadWorld world = reader.read(scenario, tree, nodes, stand_ins.find_nodes(scenario));
		world.uses_godot_shadows = world.uses_godot_shadows || has_unknown_objects(scenario, world);
		// Materials identify a stand-in by its specular amount, which no other light may have.
		std::set<float> other_speculars;
		for (const godot::Light3D &light : world.other_lights) {
			other_speculars.insert(
					static_cast<float>(light.get_param(godot::Light3D::PARAM_SPECULAR)));
		}
		const bool is_compiled = render_side->are_compiled(list_light_kinds(*world.frame->scene));
		if (is_gradual && world.frame->requests.empty()) {
			// Materials are first, since masks without them show nothing.
			world.frame->max_compilations = receiver_materials.has_copied() ? 0 : 1;
		}
		const bool is_pending = world.frame->max_compilations && !is_compiled;
		world.frame->receiver_lights = stand_ins.update(
				scenario, choose_stand_ins(world, has_failed || is_pending), other_speculars);
		world.frame->mask_scale = settings.mask_resolution_scale;
		for (const ViewDetail &view : world.frame->views) {
			needed.size_px = glm::max(needed.size_px, view.size_px);
			needed.has_depth = needed.has_depth || view.is_multisampled || world.frame->has_faded;
		}
		needed.mask_count = std::max(
				needed.mask_count, static_cast<uint32_t>(world.frame->scene->lights.size()));
		std::unique_ptr<ScenarioEffect> &effect = effects[scenario];
		if (!effect) {
			effect = std::make_unique<ScenarioEffect>(scenario, render_side);
		}
		effect->update(world.frame, tree);
	}
	reader.end_frame();
	notices.flush();
	stand_ins.end_frame();
	const std::vector<ShadowNode *> &nodes = get_shadow_nodes();
	if (nodes.empty() || !settings.is_enabled) {
		receiver_materials.clear();
	} else {
		// Any GnomonShadow3D can receive the shaders.
		receiver_materials.end_frame(nodes.front()->get_node(),
				godot::SceneTree(nodes.front()->get_node().get_tree().get_object()));
	}
	if (needed.mask_count > 0 && needed.size_px.x > 0) {
		reserve(needed);
	}
}

bool AddonServer::has_unknown_objects(godot::RID p_scenario, const ReadWorld &p_world) {
	if (settings.keep_godot_shadows != KeepGodotShadows::AUTO) {
		return settings.keep_godot_shadows == KeepGodotShadows::ALWAYS;
	}
	// The editor draws its own grid and gizmos, which are no nodes.
	if (!is_editor && p_world.unknown_object_count > 0 && !p_world.masked_lights.empty() &&
			worlds_with_unknown.insert(p_scenario).second) {
		notices.add("unknown objects", text(p_world.unknown_object_count, " object(s)"),
				"in view are no nodes, such as the tiles of a terrain add-on: they cast no shadow "
				"of "
				"Gnomon, and the lights of their world keep Godot's shadow for them. Add-ons hand "
				"them over with GnomonServer.add_caster; the project setting "
				"rendering/gnomon/keep_godot_shadows turns this off.");
	}
	return worlds_with_unknown.contains(p_scenario);
}

void AddonServer::reserve(const ReceiverSpace &p_space) {
	if (reserved.holds(p_space)) {
		return;
	}
	reserved.add(p_space);
	server.call_on_render_thread(
			godot::Callable([=, side = render_side](auto) { side->reserve(p_space); }));
}

std::vector<NeededStandIn> AddonServer::choose_stand_ins(
		const ReadWorld &p_world, bool p_has_failed) const {
	std::vector<NeededStandIn> needed;
	if (p_world.receivers.masked.empty()) {
		return needed;
	}
	const bool all_need_godot_shadow = p_has_failed || p_world.uses_godot_shadows;
	for (size_t index = 0; index < p_world.masked_lights.size(); ++index) {
		const godot::Light3D &light = p_world.masked_lights[index];
		needed.push_back({ light, static_cast<int32_t>(index),
				// Godot draws a projector's texture only with its shadow.
				all_need_godot_shadow || light.get_projector() ||
						reaches(light, p_world.receivers.others) });
	}
	for (const godot::Light3D &light : p_world.other_lights) {
		if ((!godot::cast<godot::DirectionalLight3D>(light) || light.has_shadow()) &&
				light.get_param(godot::Light3D::PARAM_SIZE) > 0) {
			// It has no mask, but the light() of materials needs its size, which only the table of
			// lights provides.
			needed.push_back({ light });
		}
	}
	return needed;
}

} // namespace gnomon
