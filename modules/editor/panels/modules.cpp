#include "modules/core/module_registry.h"
#include "modules/editor/editor_context.h"

#include <imgui.h>

namespace gnomon {

namespace {

void draw_module(EditorContext &r_context, const ModuleInfo &p_module) {
	ImGui::TableNextRow();
	ImGui::TableNextColumn();
	bool is_enabled = p_module.is_enabled;
	const bool is_changed = ImGui::Checkbox(("##" + p_module.name).c_str(), &is_enabled);
	r_context.note_item("module " + p_module.name);
	if (is_changed) {
		const std::string name = p_module.name; // the list may change
		r_context.attempt([&] {
			r_context.document.set_module_enabled(name, is_enabled);
			r_context.say((is_enabled ? "Enabled " : "Disabled ") + name);
		});
	}
	ImGui::TableNextColumn();
	ImGui::TextWrapped("%s", p_module.name.c_str());
	ImGui::TableNextColumn();
	ImGui::TextWrapped("%s", p_module.description.c_str());
	ImGui::TableNextColumn();
	ImGui::TextWrapped("%s", p_module.source.c_str());
	ImGui::TableNextColumn();
	ImGui::TextWrapped("%s", p_module.version.c_str());
	ImGui::TableNextColumn();
	if (!p_module.doc.empty()) {
		ImGui::PushStyleColor(ImGuiCol_Text, IM_COL32(120, 170, 255, 255));
		ImGui::TextWrapped("%s", p_module.doc.c_str());
		ImGui::PopStyleColor();
		if (ImGui::IsItemHovered()) {
			ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
		}
		if (ImGui::IsItemClicked()) {
			r_context.wanted_page = p_module.doc;
			r_context.command = EditorCommand::READ_PAGE;
		}
	}
}

} // namespace

void draw_modules(EditorContext &r_context) {
	if (!r_context.begin_tab("Modules")) {
		return;
	}
	ImGui::BeginChild("modules");
	if (ImGui::BeginTable("modules", 6, ImGuiTableFlags_RowBg)) {
		const char *const HEADINGS[] = { "on", "module", "what it is", "source", "version",
			"page" };
		const float WEIGHTS[] = { 0.3f, 1.2f, 1.8f, 1.4f, 0.5f, 1.4f };
		for (int column = 0; column < 6; ++column) {
			ImGui::TableSetupColumn(
					HEADINGS[column], ImGuiTableColumnFlags_WidthStretch, WEIGHTS[column]);
		}
		ImGui::TableHeadersRow();
		// A copy: a checkbox changes the list.
		const std::vector<ModuleInfo> modules = ModuleRegistry::get_modules();
		for (const ModuleInfo &module : modules) {
			if (module.can_disable) {
				draw_module(r_context, module);
			}
		}
		ImGui::EndTable();
	}
	ImGui::EndChild();
	ImGui::EndTabItem();
}

} // namespace gnomon
