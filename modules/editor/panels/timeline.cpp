// The panel "Timeline", which chooses and plays an animation of the scene.

#include "modules/core/text.h"
#include "modules/editor/editor_context.h"

#include <imgui.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace gnomon {

namespace {

const double MAX_SPEED = 10;

/// Shows a tooltip above the last drawn widget, so that the widget's value stays visible. Hidden
/// while the widget is dragged.
void show_tooltip(const std::string &p_text) {
	if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled) || ImGui::IsItemActive()) {
		return;
	}
	const ImVec2 minimum = ImGui::GetItemRectMin();
	const ImVec2 maximum = ImGui::GetItemRectMax();
	const bool is_right = minimum.x + maximum.x > ImGui::GetIO().DisplaySize.x;
	ImGui::SetNextWindowPos(
			ImVec2(is_right ? maximum.x : minimum.x, minimum.y - ImGui::GetStyle().ItemSpacing.y),
			ImGuiCond_Always, ImVec2(is_right ? 1.0f : 0.0f, 1.0f));
	ImGui::SetTooltip("%s", p_text.c_str());
}

/// Draws a button with a triangle, or with two bars while the animation plays.
void draw_play_button(EditorContext &r_context) {
	const Timeline &timeline = r_context.document.get_timeline();
	const float side = ImGui::GetFrameHeight();
	if (ImGui::Button("##play", ImVec2(1.5f * side, side))) {
		r_context.command = EditorCommand::PLAY_ANIMATION;
	}
	r_context.record_item_rect("timeline play");
	const ImVec2 minimum = ImGui::GetItemRectMin();
	const ImVec2 maximum = ImGui::GetItemRectMax();
	const ImVec2 center(0.5f * (minimum.x + maximum.x), 0.5f * (minimum.y + maximum.y));
	const float half = 0.28f * side;
	const ImU32 color = ImGui::GetColorU32(ImGuiCol_Text);
	ImDrawList &list = *ImGui::GetWindowDrawList();
	if (timeline.is_playing()) {
		for (const float sign : { -1.0f, 1.0f }) {
			const float x = center.x + sign * 0.6f * half;
			list.AddRectFilled(ImVec2(x - 0.35f * half, center.y - half),
					ImVec2(x + 0.35f * half, center.y + half), color);
		}
	} else {
		list.AddTriangleFilled(ImVec2(center.x - 0.8f * half, center.y - half),
				ImVec2(center.x + half, center.y), ImVec2(center.x - 0.8f * half, center.y + half),
				color);
	}
	show_tooltip(timeline.is_playing() ? "Space: pause" : "Space: play the animation");
}

void draw_animations(EditorContext &r_context) {
	Timeline &timeline = r_context.document.get_timeline();
	const Animation *shown = timeline.get_animation();
	const auto choose = [&](const std::string &p_name, const char *p_label, bool p_is_shown) {
		if (ImGui::Selectable(p_label, p_is_shown)) {
			timeline.choose(p_name);
			r_context.viewport.needs_redraw = true;
		}
		r_context.record_item_rect(text("choice ", p_label));
	};
	ImGui::SetNextItemWidth(9.0f * ImGui::GetFontSize());
	if (ImGui::BeginCombo("##animation", shown ? shown->name.c_str() : "at rest")) {
		choose("", "at rest", shown == nullptr);
		for (const auto &animation : r_context.document.get_scene().animations) {
			ImGui::PushID(animation.get());
			choose(animation->name, animation->name.c_str(), animation.get() == shown);
			ImGui::PopID();
		}
		ImGui::EndCombo();
	}
	r_context.record_item_rect("timeline animation");
	show_tooltip("The animation that poses the scene; at rest: the pose in the file. Not saved");
}

void draw_time(EditorContext &r_context, float p_width) {
	Timeline &timeline = r_context.document.get_timeline();
	const Animation *shown = timeline.get_animation();
	const double begin_s = 0;
	const double end_s = shown ? shown->duration_s : 0;
	double time_s = timeline.get_time_s();
	char format[64];
	std::snprintf(format, sizeof(format), shown ? "%%.2f / %.2f s" : "", end_s);
	ImGui::BeginDisabled(shown == nullptr || !(end_s > 0));
	ImGui::SetNextItemWidth(p_width);
	if (ImGui::SliderScalar("##time", ImGuiDataType_Double, &time_s, &begin_s, &end_s, format,
				ImGuiSliderFlags_AlwaysClamp)) {
		timeline.seek(time_s);
		r_context.viewport.is_moving = true;
		r_context.viewport.needs_redraw = true;
	}
	if (ImGui::IsItemActivated()) {
		timeline.pause();
	}
	ImGui::EndDisabled();
	r_context.record_item_rect("timeline time");
	show_tooltip(shown ? "Time of the shown pose. Drag, or Ctrl and click to type it"
					   : "Choose an animation, or play");
}

void draw_speed(EditorContext &r_context) {
	Timeline &timeline = r_context.document.get_timeline();
	double speed = timeline.get_speed();
	const double minimum = -MAX_SPEED;
	ImGui::SetNextItemWidth(4.0f * ImGui::GetFontSize());
	if (ImGui::DragScalar("##speed", ImGuiDataType_Double, &speed, 0.01f, &minimum, &MAX_SPEED,
				"%.2f x", ImGuiSliderFlags_AlwaysClamp)) {
		timeline.set_speed(speed);
	}
	r_context.record_item_rect("timeline speed");
	show_tooltip("Playback speed: 1 as authored, below 0 backwards, -10..10");
	ImGui::SameLine();
	bool loops = timeline.loops();
	if (ImGui::Checkbox("loop", &loops)) {
		timeline.set_loops(loops);
	}
	r_context.record_item_rect("timeline loop");
	show_tooltip("On: restarts at the end. Off: pauses there");
}

} // namespace

void draw_timeline(EditorContext &r_context) {
	if (ImGui::Begin("Timeline", nullptr,
				PANEL_FLAGS | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoScrollbar)) {
		draw_play_button(r_context);
		ImGui::SameLine();
		draw_animations(r_context);
		ImGui::SameLine();
		const ImGuiStyle &style = ImGui::GetStyle();
		const float speed_width = 4.0f * ImGui::GetFontSize() + ImGui::GetFrameHeight() +
				ImGui::CalcTextSize("loop").x + 2.0f * style.ItemSpacing.x +
				style.ItemInnerSpacing.x;
		draw_time(r_context,
				std::max(ImGui::GetContentRegionAvail().x - speed_width,
						4.0f * ImGui::GetFontSize()));
		ImGui::SameLine();
		draw_speed(r_context);
	}
	ImGui::End();
}

} // namespace gnomon
