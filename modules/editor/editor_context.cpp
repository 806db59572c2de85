#include "modules/editor/editor_context.h"

#include "modules/scene/node_properties.h"

#include <imgui.h>
#include <nlohmann/json.hpp>

namespace gnomon {

const Light3D *EditorContext::find_light() const {
	if (const auto *selected = dynamic_cast<const Light3D *>(document.get_selected())) {
		return selected;
	}
	for (const Light3D *light : document.get_scene().find_nodes<Light3D>()) {
		if (std::get<bool>(get_node_property(*light, "shadow_enabled"))) {
			return light;
		}
	}
	return nullptr;
}

std::string EditorContext::find_light_name() const {
	const Light3D *light = find_light();
	return light != nullptr ? light->name : "";
}

std::shared_ptr<const SceneSnapshot> EditorContext::build_viewport_snapshot() const {
	Camera3D camera;
	camera.name = "Viewport";
	viewport.camera.apply(camera);
	return build_snapshot(document.get_scene(), camera);
}

void EditorContext::record_item_rect(const std::string &p_name) {
	if (ImGui::IsWindowAppearing()) {
		return; // a window that has just opened gets its final position in the next frame
	}
	const ImVec2 top_left = ImGui::GetItemRectMin();
	const ImVec2 bottom_right = ImGui::GetItemRectMax();
	items[p_name] = { top_left.x, top_left.y, bottom_right.x, bottom_right.y };
}

bool EditorContext::begin_tab(const char *p_name, const std::string &p_addition) {
	// ImGui identifies the tab by the part after ###, so that the addition may change.
	const std::string label = p_name + p_addition + "###" + p_name;
	const bool is_requested = requested_tab == p_name;
	const bool is_shown = ImGui::BeginTabItem(
			label.c_str(), nullptr, is_requested ? ImGuiTabItemFlags_SetSelected : 0);
	record_item_rect(std::string("tab ") + p_name);
	if (is_requested && is_shown) {
		requested_tab.clear();
	}
	if (is_shown) {
		shown_tab = p_name;
	}
	return is_shown;
}

void EditorContext::draw_tab(
		const char *p_name, const std::function<void()> &p_draw, const std::string &p_addition) {
	if (begin_tab(p_name, p_addition)) {
		ImGui::BeginChild(p_name);
		p_draw();
		ImGui::EndChild();
		ImGui::EndTabItem();
	}
}

std::string EditorContext::describe_items(const EditorProgress &p_progress) const {
	nlohmann::json positions = nlohmann::json::object();
	for (const auto &[name, rectangle] : items) {
		positions[name] = { rectangle.x, rectangle.y, rectangle.z, rectangle.w };
	}
	const Node3D *selected = document.get_selected();
	const Timeline &timeline = document.get_timeline();
	const Animation *animation = timeline.get_animation();
	const double NO_MAE = -1.0; // while there is no reference
	return nlohmann::json(
			{ { "items", positions }, { "selected", selected ? selected->name : "" },
					{ "status", status }, { "is_changed", document.is_changed() },
					{ "images", p_progress.image_count }, { "is_resting", p_progress.is_resting },
					{ "answers_ms", p_progress.answers_ms }, { "frame", p_progress.frame },
					{ "timeline",
							{ { "animation", animation ? animation->name : "" },
									{ "time_s", timeline.get_time_s() },
									{ "is_playing", timeline.is_playing() } } },
					{ "error",
							{ { "light", error.light }, { "is_tracing", error.is_tracing },
									{ "refusal", error.refusal },
									{ "rays", error.reference ? error.round.sample_count : 0 },
									{ "penumbra_mae",
											error.metrics ? error.metrics->penumbra.mae
														  : NO_MAE } } } })
			.dump();
}

} // namespace gnomon
