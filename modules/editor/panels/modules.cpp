#include "modules/core/module_registry.h"
#include "modules/editor/editor_context.h"

#include <imgui.h>

namespace gnomon {

namespace {

void draw_module(EditorContext &r_context, const ModuleInfo &p_module) {
	ImGui::TableNextRow();
	ImGui::TableNextColumn();
	bool is_enabled = p_module.is_enabled;
	if (!p_module.can_disable) {
		ImGui::TextDisabled("always on");
	} else if (ImGui::Checkbox(("##" + p_module.name).c_str(), &is_enabled)) {
		const std::string name = p_module.name; // the list may change
		r_context.attempt([&] {
			r_context.document.set_module_enabled(name, is_enabled);
			r_context.say((is_enabled ? "Enabled " : "Disabled ") + name);
		});
	}
	ImGui::TableNextColumn();
	ImGui::TextUnformatted(p_module.name.c_str());
	ImGui::TableNextColumn();
	ImGui::TextWrapped("%s", p_module.description.c_str());
	ImGui::TableNextColumn();
	ImGui::TextDisabled("%s", p_module.source.c_str());
	ImGui::TableNextColumn();
	ImGui::TextDisabled("%s", p_module.version.c_str());
	ImGui::TableNextColumn();
	ImGui::TextDisabled("%s", p_module.doc.c_str());
}

} // namespace

void draw_modules(EditorContext &r_context) {
	if (!ImGui::BeginTabItem("Modules")) {
		return;
	}
	ImGui::BeginChild("modules");
	if (ImGui::BeginTable("modules", 6, ImGuiTableFlags_RowBg)) {
		const char *const HEADINGS[] = { "on", "module", "what it is", "source", "version",
			"page" };
		const float WEIGHTS[] = { 0.4f, 0.9f, 2.0f, 1.2f, 0.35f, 1.1f };
		for (int column = 0; column < 6; ++column) {
			ImGui::TableSetupColumn(
					HEADINGS[column], ImGuiTableColumnFlags_WidthStretch, WEIGHTS[column]);
		}
		ImGui::TableHeadersRow();
		// A copy: a checkbox changes the list.
		const std::vector<ModuleInfo> modules = ModuleRegistry::get_modules();
		for (const ModuleInfo &module : modules) {
			if (module.layer == 4) { // techniques, filters and formats: what a user adds or leaves
				draw_module(r_context, module);
			}
		}
		ImGui::EndTable();
	}
	ImGui::EndChild();
	ImGui::EndTabItem();
}

} // namespace gnomon
