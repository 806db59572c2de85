// The tabs "Frame plan" and "Passes": the passes of the last image, and their times.

#include "modules/editor/editor_context.h"

#include <imgui.h>

namespace gnomon {

namespace {

void draw_timings(const RenderResult &p_result) {
	if (!ImGui::BeginTable("timings", 2, ImGuiTableFlags_RowBg)) {
		return;
	}
	ImGui::TableSetupColumn("pass", ImGuiTableColumnFlags_WidthStretch);
	ImGui::TableSetupColumn("ms", ImGuiTableColumnFlags_WidthFixed, 5.0f * ImGui::GetFontSize());
	for (const PassTiming &timing : p_result.timings) {
		ImGui::TableNextRow();
		ImGui::TableNextColumn();
		ImGui::TextUnformatted(timing.name.c_str());
		ImGui::TableNextColumn();
		ImGui::Text("%.2f", timing.get_cost_ms());
	}
	ImGui::EndTable();
}

void draw_entries(const FramePlan &p_plan) {
	if (!ImGui::BeginTable("plan", 3, ImGuiTableFlags_RowBg)) {
		return;
	}
	ImGui::TableSetupColumn("light", ImGuiTableColumnFlags_WidthStretch, 0.5f);
	ImGui::TableSetupColumn("pass", ImGuiTableColumnFlags_WidthStretch, 1.0f);
	ImGui::TableSetupColumn("skipped", ImGuiTableColumnFlags_WidthStretch, 1.5f);
	ImGui::TableHeadersRow();
	for (const FramePlanEntry &entry : p_plan.get_entries()) {
		ImGui::TableNextRow();
		ImGui::TableNextColumn();
		ImGui::TextUnformatted(entry.light.c_str());
		ImGui::TableNextColumn();
		ImGui::TextUnformatted(entry.pass.c_str());
		ImGui::TableNextColumn();
		ImGui::TextDisabled("%s", entry.runs ? "" : entry.reason.c_str());
	}
	ImGui::EndTable();
}

} // namespace

void draw_plan(EditorContext &r_context) {
	r_context.draw_tab("Frame plan", [&] { draw_entries(r_context.shown.plan); });
	r_context.draw_tab("Passes", [&] { draw_timings(r_context.shown); });
}

} // namespace gnomon
