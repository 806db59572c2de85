// The toolbar above the other panels, and the status bar below them.

#include "modules/core/text.h"
#include "modules/editor/editor_context.h"

#include <imgui.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>
#include <vector>

namespace gnomon {

namespace {

void draw_button(EditorContext &r_context, const char *p_label, EditorCommand p_command,
		const std::string &p_tooltip, bool p_is_enabled = true) {
	ImGui::BeginDisabled(!p_is_enabled);
	if (ImGui::Button(p_label)) {
		r_context.command = p_command;
	}
	ImGui::EndDisabled();
	r_context.record_item_rect(text("button ", p_label));
	if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) {
		ImGui::SetTooltip("%s", p_tooltip.c_str());
	}
	ImGui::SameLine();
}

void request_open(EditorContext &r_context, const std::filesystem::path &p_path) {
	r_context.open_path = p_path;
	r_context.command = EditorCommand::OPEN;
	ImGui::CloseCurrentPopup();
}

void draw_scenes(EditorContext &r_context, const char *p_heading,
		const std::vector<std::filesystem::path> &p_scenes) {
	ImGui::TextDisabled("%s", p_heading);
	ImGui::PushID(p_heading); // the same scene may be in both lists
	for (const std::filesystem::path &scene : p_scenes) {
		if (ImGui::Selectable(scene.string().c_str(), scene == r_context.document.get_path())) {
			request_open(r_context, scene);
		}
		r_context.record_item_rect("open " + scene.filename().string());
	}
	ImGui::PopID();
}

/// Draws the menu of scenes to open: a field for a path, the project's scenes and recent scenes.
void draw_open_menu(EditorContext &r_context) {
	if (!ImGui::BeginPopup("open")) {
		return;
	}
	static char path[1024] = {};
	ImGui::SetNextItemWidth(30.0f * ImGui::GetFontSize());
	if (ImGui::InputTextWithHint("##path", "A project's folder, or a .gltf or .glb file", path,
				sizeof(path), ImGuiInputTextFlags_EnterReturnsTrue) &&
			path[0] != 0) {
		request_open(r_context, path);
	}
	r_context.record_item_rect("open path");
	draw_scenes(r_context, "In this project", r_context.document.get_project().scenes);
	draw_scenes(r_context, "Recent", { r_context.recent.begin(), r_context.recent.end() });
	ImGui::EndPopup();
}

} // namespace

void draw_toolbar(EditorContext &r_context) {
	const UndoHistory &history = r_context.document.get_history();
	if (ImGui::Begin("Toolbar", nullptr,
				PANEL_FLAGS | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoScrollbar)) {
		draw_button(r_context, "Open", EditorCommand::SHOW_OPEN_MENU,
				"Ctrl+O: open another scene or project");
		if (std::exchange(r_context.shows_open_menu, false)) {
			ImGui::OpenPopup("open");
		}
		draw_open_menu(r_context);
		draw_button(r_context, "Save", EditorCommand::SAVE, "Ctrl+S: write the scene",
				r_context.document.is_changed());
		draw_button(r_context, "Undo", EditorCommand::UNDO,
				"Ctrl+Z: " + (history.can_undo() ? history.get_undo_name() : "nothing to undo"),
				history.can_undo());
		draw_button(r_context, "Redo", EditorCommand::REDO,
				"Ctrl+Shift+Z: " +
						(history.can_redo() ? history.get_redo_name() : "nothing to redo"),
				history.can_redo());
		draw_button(r_context, "Frame", EditorCommand::FRAME,
				"F: move the camera to show the selected node, or the scene");
		draw_button(
				r_context, "Play", EditorCommand::PLAY, "F5: save, and run the game on this scene");
		ImGui::AlignTextToFramePadding();
		ImGui::TextDisabled("%s%s", r_context.document.get_path().filename().string().c_str(),
				r_context.document.is_changed() ? " *" : "");
		if (ImGui::IsItemHovered()) {
			ImGui::SetTooltip("%s", r_context.document.get_path().string().c_str());
		}
	}
	ImGui::End();
}

void draw_status(EditorContext &r_context) {
	if (ImGui::Begin("Status", nullptr,
				PANEL_FLAGS | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoScrollbar)) {
		char frame[160];
		std::snprintf(frame, sizeof(frame), "%.1f ms   %u x %u   %.80s", r_context.shown_ms,
				r_context.image_size_px.x, r_context.image_size_px.y,
				r_context.device.name.c_str());
		const ImVec4 red(1.0f, 0.45f, 0.4f, 1.0f);
		const ImVec4 plain = ImGui::GetStyleColorVec4(ImGuiCol_Text);
		const float frame_x = std::max(
				ImGui::GetWindowWidth() - ImGui::CalcTextSize(frame).x - ImGui::GetFontSize(),
				0.0f);
		const ImVec2 position = ImGui::GetWindowPos();
		ImGui::PushClipRect(position,
				ImVec2(position.x + frame_x - ImGui::GetFontSize(),
						position.y + ImGui::GetWindowHeight()),
				true);
		const std::string first_line = r_context.status.substr(0, r_context.status.find('\n'));
		ImGui::TextColored(r_context.is_status_error ? red : plain, "%s", first_line.c_str());
		ImGui::PopClipRect();
		if (ImGui::IsItemHovered()) {
			ImGui::BeginTooltip();
			ImGui::PushTextWrapPos(60.0f * ImGui::GetFontSize());
			ImGui::TextUnformatted(r_context.status.c_str());
			ImGui::PopTextWrapPos();
			ImGui::EndTooltip();
		}
		ImGui::SameLine(frame_x);
		ImGui::TextDisabled("%s", frame);
	}
	ImGui::End();
}

} // namespace gnomon
