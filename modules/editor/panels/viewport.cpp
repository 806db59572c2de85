// The panel "Viewport": the image with its overlays, the camera's controls, and the choice of view.

#include "modules/editor/panels/viewport_gizmos.h"
#include "modules/shadows/shadow_registry.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

const double ROTATION_RAD_PER_PX = 0.006;
const double ZOOM_PER_STEP = 0.87; // factor of the distance to the pivot, per wheel step
const double FLIGHT_DISTANCES_PER_SECOND = 0.8; // in distances to the pivot

/// Moves the camera while W, A, S, D, Q or E is pressed; four times as fast with Shift.
void fly(ViewportState &r_viewport) {
	const ImGuiIO &io = ImGui::GetIO();
	// The key codes are GLFW's, which are ASCII for letters.
	const auto is_down = [&](int p_letter) { return io.KeysDown[p_letter] ? 1.0 : 0.0; };
	const glm::dvec3 direction(
			is_down('D') - is_down('A'), is_down('E') - is_down('Q'), is_down('S') - is_down('W'));
	if (direction != glm::dvec3(0.0)) {
		const double fast = io.KeyShift ? 4.0 : 1.0;
		r_viewport.camera.move(direction *
				(fast * FLIGHT_DISTANCES_PER_SECOND * r_viewport.camera.get_distance_m() *
						double(io.DeltaTime)));
	}
}

/// Moves the camera. Middle button, or Alt and left button: orbit, or pan with Shift; wheel: zoom;
/// right button: look around and fly.
void move_camera(ViewportState &r_viewport, bool p_is_hovered) {
	const ImGuiIO &io = ImGui::GetIO();
	const uint64_t before = r_viewport.camera.get_revision();
	const glm::dvec2 drag(io.MouseDelta.x, io.MouseDelta.y);
	const bool orbits = ImGui::IsMouseDown(ImGuiMouseButton_Middle) ||
			(io.KeyAlt && ImGui::IsMouseDown(ImGuiMouseButton_Left));
	if (ImGui::IsItemActive() && orbits && drag != glm::dvec2(0.0)) {
		if (io.KeyShift) {
			r_viewport.camera.pan(drag / double(std::max(r_viewport.size_px.y, 1u)));
		} else {
			r_viewport.camera.orbit(-drag.x * ROTATION_RAD_PER_PX, -drag.y * ROTATION_RAD_PER_PX);
		}
	}
	if (ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Right)) {
		if (drag != glm::dvec2(0.0)) {
			r_viewport.camera.rotate_in_place(
					-drag.x * ROTATION_RAD_PER_PX, -drag.y * ROTATION_RAD_PER_PX);
		}
		fly(r_viewport);
	}
	if (p_is_hovered && io.MouseWheel != 0.0f) {
		r_viewport.camera.zoom(std::pow(ZOOM_PER_STEP, double(io.MouseWheel)));
	}
	if (r_viewport.camera.get_revision() != before) {
		r_viewport.is_moving = true;
		r_viewport.needs_redraw = true;
	}
}

/// Draws the choice of the debug view and of the technique to compare with.
void draw_choices(EditorContext &r_context) {
	ViewportState &viewport = r_context.viewport;
	const auto choose = [&](std::string &r_choice, const std::string &p_choice,
								const char *p_label) {
		if (ImGui::Selectable(p_label, r_choice == p_choice)) {
			r_choice = p_choice;
			viewport.needs_redraw = true;
		}
		r_context.record_item_rect(std::string("choice ") + p_label);
	};
	ImGui::SetNextItemWidth(10.0f * ImGui::GetFontSize());
	const char *shown = viewport.debug_view.empty() ? "image" : viewport.debug_view.c_str();
	if (ImGui::BeginCombo("##view", shown)) {
		viewport.wants_debug_views |= ImGui::IsWindowAppearing();
		choose(viewport.debug_view, "", "image");
		bool has_error = false;
		for (const std::string &id : viewport.debug_views) {
			choose(viewport.debug_view, id, id.c_str());
			has_error |= id == "error";
		}
		// Choosing it starts the tracing of the reference, which makes the view available.
		if (!has_error && ShadowRegistry::find_reference() != nullptr) {
			choose(viewport.debug_view, "error", "error");
		}
		ImGui::EndCombo();
	}
	r_context.record_item_rect("view");
	ImGui::SameLine();
	ImGui::SetNextItemWidth(12.0f * ImGui::GetFontSize());
	const std::string against = "against " + viewport.compared_technique;
	if (ImGui::BeginCombo("##against",
				viewport.compared_technique.empty() ? "one technique" : against.c_str())) {
		choose(viewport.compared_technique, "", "one technique");
		for (const ShadowTechniqueInfo &technique : ShadowRegistry::get_all()) {
			choose(viewport.compared_technique, technique.id, technique.id.c_str());
			if (ImGui::IsItemHovered()) {
				ImGui::SetTooltip("%s\n%s", technique.name.c_str(), technique.source.c_str());
			}
		}
		ImGui::EndCombo();
	}
	r_context.record_item_rect("against");
	ImGui::SameLine();
	viewport.is_guide_changed |= ImGui::Checkbox("penumbra", &viewport.shows_penumbra);
	r_context.record_item_rect("penumbra");
	if (ImGui::IsItemHovered()) {
		ImGui::SetTooltip("Lines where the selected light's penumbra ends: orange outer (r), blue "
						  "inner (t)");
	}
	if (!viewport.compared_technique.empty()) {
		ImGui::SameLine();
		const Light3D *light = r_context.find_light();
		ImGui::TextDisabled("right of the line, for %s", light ? light->name.c_str() : "no light");
	}
}

/// Draws the image, or two images with a line between them.
void draw_images(EditorContext &r_context, ImVec2 p_top_left, ImVec2 p_size) {
	if (r_context.image == nullptr) {
		return;
	}
	ImDrawList &list = *ImGui::GetWindowDrawList();
	const ImVec2 bottom_right(p_top_left.x + p_size.x, p_top_left.y + p_size.y);
	list.AddImage(r_context.image, p_top_left, bottom_right);
	if (r_context.compared_image == nullptr) {
		return;
	}
	const float fraction = r_context.viewport.divider_position;
	const float x = p_top_left.x + fraction * p_size.x;
	list.AddImage(r_context.compared_image, ImVec2(x, p_top_left.y), bottom_right,
			ImVec2(fraction, 0.0f), ImVec2(1.0f, 1.0f));
	list.AddLine(
			ImVec2(x, p_top_left.y), ImVec2(x, bottom_right.y), IM_COL32(255, 255, 255, 220), 2.0f);
}

/// Draws the errors of changed shaders over the image.
void draw_shader_errors(const EditorContext &p_context, ImVec2 p_top_left, ImVec2 p_size) {
	std::string lines;
	for (const auto &[shader, failure] : p_context.shader_errors) {
		lines += (lines.empty() ? "" : "\n") + failure;
	}
	if (lines.empty()) {
		return;
	}
	const float margin = 0.5f * ImGui::GetFontSize();
	const float wrap = std::max(p_size.x - 4.0f * margin, 1.0f);
	const ImVec2 size = ImGui::CalcTextSize(lines.c_str(), nullptr, false, wrap);
	ImDrawList &list = *ImGui::GetWindowDrawList();
	list.AddRectFilled(p_top_left,
			ImVec2(p_top_left.x + p_size.x, p_top_left.y + size.y + 2.0f * margin),
			IM_COL32(90, 10, 10, 220));
	list.AddText(ImGui::GetFont(), ImGui::GetFontSize(),
			ImVec2(p_top_left.x + margin, p_top_left.y + margin), IM_COL32_WHITE, lines.c_str(),
			nullptr, wrap);
}

/// Makes the dividing line draggable. Call it after the viewport's button, which it overlaps.
void draw_line_handle(EditorContext &r_context, ImVec2 p_top_left, ImVec2 p_size) {
	if (r_context.compared_image == nullptr) {
		return;
	}
	const float half_width_px = 5.0f;
	float &fraction = r_context.viewport.divider_position;
	ImGui::SetCursorScreenPos(
			ImVec2(p_top_left.x + fraction * p_size.x - half_width_px, p_top_left.y));
	ImGui::InvisibleButton("line", ImVec2(2.0f * half_width_px, p_size.y));
	ImGui::SetItemAllowOverlap();
	r_context.record_item_rect("line");
	if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
		ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
	}
	if (ImGui::IsItemActive()) {
		fraction = std::clamp((ImGui::GetIO().MousePos.x - p_top_left.x) / p_size.x, 0.0f, 1.0f);
	}
}

/// Requests to select the node under the mouse, after a click that is not a drag.
void pick(EditorContext &r_context, const ViewportProjection &p_projection) {
	const float MAX_CLICK_MOVEMENT_PX = 4.0f; // of mouse movement; above, it is a drag
	const ImGuiIO &io = ImGui::GetIO();
	const bool is_click = io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left] <
			MAX_CLICK_MOVEMENT_PX * MAX_CLICK_MOVEMENT_PX;
	if (ImGui::IsItemDeactivated() && ImGui::IsMouseReleased(ImGuiMouseButton_Left) && is_click &&
			!io.KeyAlt) {
		r_context.viewport.pick =
				ViewportPick{ p_projection.get_eye(), p_projection.compute_direction(io.MousePos) };
	}
}

} // namespace

void draw_viewport(EditorContext &r_context) {
	if (ImGui::Begin("Viewport", nullptr,
				PANEL_FLAGS | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse)) {
		draw_choices(r_context);
		const ImVec2 top_left = ImGui::GetCursorScreenPos();
		ImVec2 size = ImGui::GetContentRegionAvail();
		size = ImVec2(std::max(size.x, 16.0f), std::max(size.y, 16.0f));
		const glm::uvec2 size_px(static_cast<uint32_t>(size.x), static_cast<uint32_t>(size.y));
		if (size_px != r_context.viewport.size_px) {
			r_context.viewport.size_px = size_px;
			r_context.viewport.needs_redraw = true;
		}
		draw_images(r_context, top_left, size);
		ImGui::InvisibleButton("viewport", size,
				ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle |
						ImGuiButtonFlags_MouseButtonRight);
		ImGui::SetItemAllowOverlap();
		r_context.record_item_rect("viewport");
		move_camera(r_context.viewport, ImGui::IsItemHovered());
		const ViewportProjection projection(r_context.viewport.camera, top_left, size);
		pick(r_context, projection);
		draw_line_handle(r_context, top_left, size);
		ImGui::PushClipRect(top_left, ImVec2(top_left.x + size.x, top_left.y + size.y), true);
		draw_penumbra_lines(r_context, projection);
		draw_node_marks(r_context, projection);
		draw_gizmos(r_context, projection);
		draw_shader_errors(r_context, top_left, size);
		ImGui::PopClipRect();
	}
	ImGui::End();
}

} // namespace gnomon
