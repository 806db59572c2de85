// The positions of the panels in the window, and the lines between them that can be dragged.

#include "modules/editor/editor_context.h"
#include "modules/editor/editor_settings.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace gnomon {

const int PANEL_FLAGS = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
		ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoBringToFrontOnFocus;

namespace {

void set_next_window(ImVec2 p_position, ImVec2 p_size) {
	ImGui::SetNextWindowPos(p_position);
	ImGui::SetNextWindowSize(p_size);
}

/// Draws a line that can be dragged to change a fraction of the window. p_window: size in pixels
/// along the drag for a fraction of 1. p_sign: -1 if a drag to the right or down lowers r_fraction.
void draw_splitter(const char *p_id, ImVec2 p_position, ImVec2 p_size, bool p_is_vertical,
		float p_window, float p_sign, float &r_fraction) {
	set_next_window(p_position, p_size);
	ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
	ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
	ImGui::Begin(p_id, nullptr,
			ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoNav |
					ImGuiWindowFlags_NoMove);
	ImGui::InvisibleButton("line", p_size);
	if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
		ImGui::SetMouseCursor(
				p_is_vertical ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
	}
	if (ImGui::IsItemActive()) {
		const ImVec2 drag = ImGui::GetIO().MouseDelta;
		r_fraction = std::clamp(
				r_fraction + p_sign * (p_is_vertical ? drag.x : drag.y) / std::max(p_window, 1.0f),
				EditorLayout::MIN_FRACTION, EditorLayout::MAX_FRACTION);
	}
	ImGui::End();
	ImGui::PopStyleVar(2);
}

} // namespace

void draw_layout(EditorContext &r_context, EditorLayout &r_layout) {
	const ImVec2 window = ImGui::GetIO().DisplaySize;
	// Smallest size of the area between toolbar, status bar and side panels, in a tiny window.
	const ImVec2 MIN_MIDDLE_PX(32.0f, 64.0f);
	// Height of the toolbar, the status bar and the timeline.
	const float bar = ImGui::GetFrameHeight() + 2.0f * ImGui::GetStyle().WindowPadding.y;
	const float line = ImGui::GetFontSize() * 0.3f; // thickness of a splitter
	const float left = std::floor(window.x * r_layout.left);
	const float right = std::floor(window.x * r_layout.right);
	const float middle = std::max(window.x - left - right - 2.0f * line, MIN_MIDDLE_PX.x);
	const float height = std::max(window.y - 2.0f * bar, MIN_MIDDLE_PX.y);
	const float bottom = std::floor(height * r_layout.bottom);
	const bool has_timeline = !r_context.document.get_scene().animations.empty();
	const float viewport = height - bottom - line - (has_timeline ? bar : 0.0f);
	ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(16, 16));
	set_next_window(ImVec2(0, 0), ImVec2(window.x, bar));
	draw_toolbar(r_context);
	set_next_window(ImVec2(0, bar), ImVec2(left, height));
	draw_scene_tree(r_context);
	draw_splitter("##left", ImVec2(left, bar), ImVec2(line, height), /*p_is_vertical=*/true,
			window.x, /*p_sign=*/1.0f, r_layout.left);
	set_next_window(ImVec2(left + line, bar), ImVec2(middle, viewport));
	draw_viewport(r_context);
	if (has_timeline) {
		set_next_window(ImVec2(left + line, bar + viewport), ImVec2(middle, bar));
		draw_timeline(r_context);
	}
	draw_splitter("##bottom", ImVec2(left + line, bar + height - bottom - line),
			ImVec2(middle, line), /*p_is_vertical=*/false, height, /*p_sign=*/-1.0f,
			r_layout.bottom);
	set_next_window(ImVec2(left + line, bar + height - bottom), ImVec2(middle, bottom));
	if (ImGui::Begin("Frame", nullptr, PANEL_FLAGS | ImGuiWindowFlags_NoTitleBar) &&
			ImGui::BeginTabBar("bottom")) {
		draw_plan(r_context);
		draw_error(r_context);
		draw_modules(r_context);
		draw_messages(r_context);
		ImGui::EndTabBar();
	}
	ImGui::End();
	draw_splitter("##right", ImVec2(left + line + middle, bar), ImVec2(line, height),
			/*p_is_vertical=*/true, window.x, /*p_sign=*/-1.0f, r_layout.right);
	set_next_window(ImVec2(window.x - right, bar), ImVec2(right, height));
	draw_inspector(r_context);
	set_next_window(ImVec2(0, window.y - bar), ImVec2(window.x, bar));
	draw_status(r_context);
	ImGui::PopStyleVar();
}

} // namespace gnomon
