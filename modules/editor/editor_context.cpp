#include "modules/editor/editor_context.h"

#include <imgui.h>
#include <nlohmann/json.hpp>

namespace gnomon {

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
