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

std::shared_ptr<const SceneSnapshot> EditorContext::build_viewport_snapshot() const {
	Camera3D camera;
	camera.name = "Viewport";
	viewport.camera.apply(camera);
	return build_snapshot(document.get_scene(), camera);
}

void EditorContext::note_item(const std::string &p_name) {
	if (ImGui::IsWindowAppearing()) {
		return; // what has just opened finds its place in the next frame
	}
	const ImVec2 least = ImGui::GetItemRectMin();
	const ImVec2 greatest = ImGui::GetItemRectMax();
	items[p_name] = { least.x, least.y, greatest.x, greatest.y };
}

std::string EditorContext::describe_items(uint32_t p_picture_count) const {
	nlohmann::json places = nlohmann::json::object();
	for (const auto &[name, rectangle] : items) {
		places[name] = { rectangle.x, rectangle.y, rectangle.z, rectangle.w };
	}
	const Node3D *selected = document.get_selected();
	return nlohmann::json({ { "items", places }, { "selected", selected ? selected->name : "" },
								  { "status", status }, { "is_changed", document.is_changed() },
								  { "pictures", p_picture_count } })
			.dump();
}

} // namespace gnomon
