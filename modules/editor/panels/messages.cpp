#include "modules/core/text.h"
#include "modules/editor/editor_context.h"

#include <imgui.h>

namespace gnomon {

void draw_messages(EditorContext &r_context) {
	if (!r_context.begin_tab("Messages", text(" (", r_context.messages.size(), ")"))) {
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
