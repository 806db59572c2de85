// The tab "Messages": errors and warnings.

#include "modules/core/text.h"
#include "modules/editor/editor_context.h"

#include <imgui.h>

namespace gnomon {

void draw_messages(EditorContext &r_context) {
	const auto draw = [&] {
		if (r_context.messages.empty()) {
			ImGui::TextDisabled("No errors and no warnings.");
		}
		for (const std::string &message : r_context.messages) {
			ImGui::TextWrapped("%s", message.c_str());
		}
	};
	r_context.draw_tab("Messages", draw, text(" (", r_context.messages.size(), ")"));
}

} // namespace gnomon
