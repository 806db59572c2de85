#include "modules/editor/panels/viewport_gizmos.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace gnomon {

namespace {

const ImU32 SELECTED_COLOR = IM_COL32(255, 200, 60, 255);
const ImU32 FILL_COLOR = IM_COL32(255, 200, 60, 50); // as SELECTED_COLOR, but transparent
const ImU32 MARK_COLOR = IM_COL32(230, 230, 230, 200);
const ImU32 OUTER_COLOR = IM_COL32(255, 150, 40, 230);
const ImU32 INNER_COLOR = IM_COL32(70, 150, 255, 230);

/// Returns the new radius of a circle whose handle is dragged: only the component of the mouse's
/// movement along the line from the centre to the handle counts.
double compute_dragged_radius(double p_radius_m, double p_metres_per_px,
		const std::optional<ImVec2> &p_center, const ImVec2 &p_handle) {
	const ImGuiIO &io = ImGui::GetIO();
	const glm::dvec2 moved(io.MouseDelta.x, io.MouseDelta.y);
	// A shorter line has no exact direction: a movement to the right increases the radius then.
	const double MIN_LENGTH_PX = 4.0;
	const glm::dvec2 direction = p_center
			? glm::dvec2(p_handle.x - p_center->x, p_handle.y - p_center->y)
			: glm::dvec2(0.0);
	const double length_px = glm::length(direction);
	if (length_px < MIN_LENGTH_PX) {
		return p_radius_m + moved.x * p_metres_per_px;
	}
	return p_radius_m * (1.0 + glm::dot(moved, direction) / (length_px * length_px));
}

/// Draws a small sun for a light, a rectangle for a camera.
void draw_mark(ImDrawList &r_list, const ImVec2 &p_position, bool p_is_light, ImU32 p_color) {
	const float radius = 0.3f * ImGui::GetFontSize();
	if (!p_is_light) {
		r_list.AddRect(ImVec2(p_position.x - 1.5f * radius, p_position.y - radius),
				ImVec2(p_position.x + 1.5f * radius, p_position.y + radius), p_color, 0.0f,
				ImDrawFlags_None, 1.5f);
		return;
	}
	r_list.AddCircleFilled(p_position, radius, p_color);
	for (int ray = 0; ray < 8; ++ray) {
		const float angle = 0.785398f * float(ray); // radians, 45 degrees per ray
		const ImVec2 direction(std::cos(angle), std::sin(angle));
		r_list.AddLine(ImVec2(p_position.x + 1.4f * radius * direction.x,
							   p_position.y + 1.4f * radius * direction.y),
				ImVec2(p_position.x + 2.0f * radius * direction.x,
						p_position.y + 2.0f * radius * direction.y),
				p_color, 1.5f);
	}
}

} // namespace

void draw_node_marks(EditorContext &r_context, const ViewportProjection &p_projection) {
	Node3D *clicked = nullptr;
	const auto draw = [&](Node3D &p_node, bool p_is_light) {
		const std::optional<ImVec2> position =
				p_projection.project(glm::dvec3(p_node.compute_world_from_node()[3]));
		if (!position || !p_projection.is_inside(*position)) {
			return;
		}
		const bool is_selected = r_context.document.get_selected() == &p_node;
		draw_mark(*ImGui::GetWindowDrawList(), *position, p_is_light,
				is_selected ? SELECTED_COLOR : MARK_COLOR);
		const float half = 0.7f * ImGui::GetFontSize();
		ImGui::PushID(&p_node);
		ImGui::SetCursorScreenPos(ImVec2(position->x - half, position->y - half));
		if (ImGui::InvisibleButton("mark", ImVec2(2.0f * half, 2.0f * half))) {
			clicked = &p_node;
		}
		ImGui::SetItemAllowOverlap(); // a handle may overlap it
		r_context.record_item_rect("mark " + p_node.name);
		if (ImGui::IsItemHovered()) {
			ImGui::SetTooltip("%s", p_node.name.c_str());
		}
		ImGui::PopID();
	};
	const Scene &scene = r_context.document.get_scene();
	for (Light3D *light : scene.find_nodes<Light3D>()) {
		draw(*light, /*p_is_light=*/true);
	}
	for (Camera3D *camera : scene.find_nodes<Camera3D>()) {
		draw(*camera, /*p_is_light=*/false);
	}
	if (clicked != nullptr) {
		r_context.document.select(clicked);
	}
}

void draw_penumbra_lines(const EditorContext &p_context, const ViewportProjection &p_projection) {
	ImDrawList &list = *ImGui::GetWindowDrawList();
	for (const PenumbraLine &line : p_context.viewport.penumbra_lines) {
		const std::optional<ImVec2> from = p_projection.project(line.from_world);
		const std::optional<ImVec2> to = p_projection.project(line.to_world);
		if (from && to) {
			list.AddLine(*from, *to, line.is_outer ? OUTER_COLOR : INNER_COLOR, 1.5f);
		}
	}
}

void draw_gizmos(EditorContext &r_context, const ViewportProjection &p_projection) {
	Node3D *node = r_context.document.get_selected();
	if (node == nullptr) {
		return;
	}
	ImDrawList &list = *ImGui::GetWindowDrawList();
	const glm::dmat4 world_from_node = node->compute_world_from_node();
	for (int axis = 0; axis < 3; ++axis) {
		if (!(glm::length(glm::dvec3(world_from_node[axis])) > 0.0)) {
			return; // scaled to zero: the axis has no direction
		}
	}
	std::vector<NodeGizmo> gizmos;
	node->add_gizmos(gizmos);
	for (const NodeGizmo &gizmo : gizmos) {
		const glm::dvec3 center(world_from_node * glm::dvec4(gizmo.center, 1.0));
		const glm::dmat3 axes(glm::normalize(glm::dvec3(world_from_node[0])),
				glm::normalize(glm::dvec3(world_from_node[1])),
				glm::normalize(glm::dvec3(world_from_node[2])));
		std::vector<ImVec2> points;
		const int SIDES = 64;
		for (int side = 0; side <= SIDES; ++side) {
			const double angle = 6.283185307179586 * side / SIDES; // 2 pi / SIDES per side
			const glm::dvec3 position = center +
					gizmo.radius_m *
							(axes *
									(std::cos(angle) * gizmo.axis_x +
											std::sin(angle) * gizmo.axis_y));
			if (const std::optional<ImVec2> point = p_projection.project(position)) {
				points.push_back(*point);
			}
		}
		list.AddPolyline(points.data(), int(points.size()), SELECTED_COLOR, ImDrawFlags_None, 2.0f);
		if (gizmo.is_filled) {
			list.AddConvexPolyFilled(points.data(), int(points.size()), FILL_COLOR);
		}
		const std::optional<ImVec2> handle =
				p_projection.project(center + gizmo.radius_m * (axes * gizmo.axis_x));
		if (gizmo.property.empty() || !handle) {
			continue;
		}
		const float handle_radius_px = 7.0f;
		const ImGuiID id = ImGui::GetID(gizmo.property.c_str());
		if (id != r_context.dragged_handle && !p_projection.is_inside(*handle)) {
			continue;
		}
		list.AddCircleFilled(*handle, handle_radius_px, SELECTED_COLOR);
		ImGui::SetCursorScreenPos(
				ImVec2(handle->x - handle_radius_px, handle->y - handle_radius_px));
		ImGui::PushID(gizmo.property.c_str());
		ImGui::InvisibleButton("handle", ImVec2(2 * handle_radius_px, 2 * handle_radius_px));
		r_context.record_item_rect("handle " + gizmo.property);
		ImGui::SetItemAllowOverlap();
		r_context.dragged_handle = ImGui::IsItemActive() ? id
				: r_context.dragged_handle == id		 ? 0
														 : r_context.dragged_handle;
		if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
			ImGui::SetTooltip("%s: %.4g", gizmo.property.c_str(), gizmo.value);
		}
		const ImGuiIO &io = ImGui::GetIO();
		if (ImGui::IsItemActive() && (io.MouseDelta.x != 0.0f || io.MouseDelta.y != 0.0f)) {
			const double radius_m = compute_dragged_radius(gizmo.radius_m,
					p_projection.compute_metres_per_px(center), p_projection.project(center),
					*handle);
			const double value =
					std::max(gizmo.value + (radius_m - gizmo.radius_m) * gizmo.value_per_m, 0.0);
			r_context.attempt([&] {
				r_context.document.set_property(*node, gizmo.property, value, /*p_is_drag=*/true);
			});
			r_context.viewport.is_moving = true;
		}
		if (ImGui::IsItemDeactivated()) {
			r_context.document.end_drag();
		}
		ImGui::PopID();
	}
}

} // namespace gnomon
