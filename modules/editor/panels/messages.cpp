#include "modules/editor/editor_context.h"

#include <imgui.h>

namespace gnomon {

void draw_messages(EditorContext &r_context) {
	const std::string label =
			"Messages (" + std::to_string(r_context.messages.size()) + ")###messages";
	if (!ImGui::BeginTabItem(label.c_str())) {
		return;
	}
	ImGui::BeginChild("messages");
	if (r_context.messages.empty()) {
		ImGui::TextDisabled("No errors and no warnings.");
	}
	for (const std::string &message : r_context.messages) {
		ImGui::TextWrapped("%s", message.c_str());
	}
	ImGui::EndChild();
	ImGui::EndTabItem();
}

} // namespace gnomon
