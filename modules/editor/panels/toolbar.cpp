#include "modules/core/text.h"
#include "modules/editor/editor_context.h"

#include <imgui.h>

#include <algorithm>
#include <cstdio>

namespace gnomon {

namespace {

bool draw_button(EditorContext &r_context, const char *p_label, const char *p_tooltip,
		bool p_is_enabled = true) {
	ImGui::BeginDisabled(!p_is_enabled);
	const bool is_pressed = ImGui::Button(p_label);
	ImGui::EndDisabled();
	r_context.note_item(text("button ", p_label));
	if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) {
		ImGui::SetTooltip("%s", p_tooltip);
	}
	ImGui::SameLine();
	return is_pressed;
}

} // namespace

void draw_toolbar(EditorContext &r_context) {
	const UndoHistory &history = r_context.document.get_history();
	if (ImGui::Begin("Toolbar", nullptr,
				PANEL_FLAGS | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoScrollbar)) {
		if (draw_button(r_context, "Save", "Ctrl+S: write the scene",
					r_context.document.is_changed())) {
			r_context.command = EditorCommand::SAVE;
		}
		if (draw_button(r_context, "Undo",
					history.can_undo() ? ("Ctrl+Z: " + history.get_undo_name()).c_str()
									   : "Ctrl+Z: nothing to undo",
					history.can_undo())) {
			r_context.command = EditorCommand::UNDO;
		}
		if (draw_button(r_context, "Redo",
					history.can_redo() ? ("Ctrl+Shift+Z: " + history.get_redo_name()).c_str()
									   : "Ctrl+Shift+Z: nothing to redo",
					history.can_redo())) {
			r_context.command = EditorCommand::REDO;
		}
		if (draw_button(r_context, "Frame", "F: show all of the selected node, or of the scene")) {
			r_context.command = EditorCommand::FRAME;
		}
		if (draw_button(r_context, "Play", "F5: save, and run the game on this scene")) {
			r_context.command = EditorCommand::PLAY;
		}
		ImGui::AlignTextToFramePadding();
		ImGui::TextDisabled("%s%s", r_context.document.get_path().filename().string().c_str(),
				r_context.document.is_changed() ? " *" : "");
	}
	ImGui::End();
}

void draw_status(EditorContext &r_context) {
	if (ImGui::Begin("Status", nullptr,
				PANEL_FLAGS | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoScrollbar)) {
		char frame[160];
		std::snprintf(frame, sizeof(frame), "%.1f ms   %u x %u   %.80s", r_context.shown_ms,
				r_context.picture_size_px.x, r_context.picture_size_px.y,
				r_context.device.name.c_str());
		const ImVec4 red(1.0f, 0.45f, 0.4f, 1.0f);
		const ImVec4 plain = ImGui::GetStyleColorVec4(ImGuiCol_Text);
		ImGui::TextColored(r_context.is_status_error ? red : plain, "%s", r_context.status.c_str());
		if (ImGui::IsItemHovered()) {
			ImGui::SetTooltip("%s", r_context.status.c_str());
		}
		ImGui::SameLine(std::max(
				ImGui::GetWindowWidth() - ImGui::CalcTextSize(frame).x - ImGui::GetFontSize(),
				0.0f));
		ImGui::TextDisabled("%s", frame);
	}
	ImGui::End();
}

} // namespace gnomon
