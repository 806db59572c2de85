#include "modules/editor/editor_context.h"

#include <imgui.h>

namespace gnomon {

void EditorContext::note_item(const std::string &p_name) {
	if (ImGui::IsWindowAppearing()) {
		return; // what has just opened finds its place in the next frame
	}
	const ImVec2 least = ImGui::GetItemRectMin();
	const ImVec2 greatest = ImGui::GetItemRectMax();
	items[p_name] = { least.x, least.y, greatest.x, greatest.y };
}

} // namespace gnomon
