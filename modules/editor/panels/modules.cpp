// The tab "Modules": switches modules on and off.

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
	r_context.record_item_rect("module " + p_module.name);
	if (is_changed) {
		r_context.attempt([&] {
			r_context.document.set_module_enabled(p_module.name, is_enabled);
			r_context.set_status((is_enabled ? "Enabled " : "Disabled ") + p_module.name);
		});
	}
	for (const std::string *cell_text :
			{ &p_module.name, &p_module.description, &p_module.source, &p_module.version }) {
		ImGui::TableNextColumn();
		ImGui::TextWrapped("%s", cell_text->c_str());
	}
	ImGui::TableNextColumn();
	if (!p_module.doc.empty()) {
		ImGui::PushStyleColor(ImGuiCol_Text, IM_COL32(120, 170, 255, 255));
		ImGui::TextWrapped("%s", p_module.doc.c_str());
		ImGui::PopStyleColor();
		if (ImGui::IsItemHovered()) {
			ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
		}
		if (ImGui::IsItemClicked()) {
			r_context.requested_page = p_module.doc;
			r_context.command = EditorCommand::OPEN_PAGE;
		}
	}
}

void draw_table(EditorContext &r_context) {
	if (!ImGui::BeginTable("modules", 6, ImGuiTableFlags_RowBg)) {
		return;
	}
	const std::pair<const char *, float> COLUMNS[] = { { "on", 0.3f }, { "module", 1.2f },
		{ "what it is", 1.8f }, { "source", 1.4f }, { "version", 0.5f }, { "page", 1.4f } };
	for (const auto &[heading, weight] : COLUMNS) {
		ImGui::TableSetupColumn(heading, ImGuiTableColumnFlags_WidthStretch, weight);
	}
	ImGui::TableHeadersRow();
	// A copy, so that all rows of a frame show the state before a click, which can also switch
	// other modules of the list.
	const std::vector<ModuleInfo> modules = ModuleRegistry::get_modules();
	for (const ModuleInfo &module : modules) {
		if (module.can_disable && !module.is_example) {
			draw_module(r_context, module);
		}
	}
	ImGui::EndTable();
}

} // namespace

void draw_modules(EditorContext &r_context) {
	r_context.draw_tab("Modules", [&] { draw_table(r_context); });
}

} // namespace gnomon
