#include "modules/editor/editor_context.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace gnomon {

namespace {

const double TURN_RAD_PER_PX = 0.006;
const double ZOOM_PER_STEP = 0.87;
const double FLIGHT_DISTANCES_PER_SECOND = 0.8;

/// Where a place of the world is in the picture; nothing behind the camera.
class ViewportProjection {
public:
	ViewportProjection(const OrbitCamera &p_camera, ImVec2 p_least, ImVec2 p_size) :
			least(p_least.x, p_least.y), size(p_size.x, p_size.y) {
		Camera3D camera;
		p_camera.apply(camera);
		camera_from_world = glm::inverse(camera.parent_from_node);
		focal_px = 0.5 * size.y / std::tan(0.5 * double(camera.vertical_fov_rad));
		near_m = camera.near_m;
	}

	std::optional<ImVec2> project(const glm::dvec3 &p_world) const {
		const glm::dvec3 place(camera_from_world * glm::dvec4(p_world, 1.0));
		if (-place.z < near_m) {
			return std::nullopt;
		}
		const glm::dvec2 px =
				least + 0.5 * size + glm::dvec2(place.x, -place.y) * (focal_px / -place.z);
		return ImVec2(float(px.x), float(px.y));
	}
	bool is_inside(const ImVec2 &p_point) const {
		return p_point.x >= least.x && p_point.y >= least.y && p_point.x < least.x + size.x &&
				p_point.y < least.y + size.y;
	}
	/// Metres at that place across the view for each pixel.
	double compute_metres_per_px(const glm::dvec3 &p_world) const {
		const glm::dvec3 place(camera_from_world * glm::dvec4(p_world, 1.0));
		return std::max(-place.z, double(near_m)) / focal_px;
	}

private:
	glm::dvec2 least;
	glm::dvec2 size;
	glm::dmat4 camera_from_world;
	double focal_px = 1;
	float near_m = 0.05f;
};

void fly(ViewportState &r_viewport) {
	const ImGuiIO &io = ImGui::GetIO();
	const auto is_down = [&](int p_letter) { return io.KeysDown[p_letter] ? 1.0 : 0.0; };
	const glm::dvec3 way(
			is_down('D') - is_down('A'), is_down('E') - is_down('Q'), is_down('S') - is_down('W'));
	if (way != glm::dvec3(0.0)) {
		const double fast = io.KeyShift ? 4.0 : 1.0;
		r_viewport.camera.move(way *
				(fast * FLIGHT_DISTANCES_PER_SECOND * r_viewport.camera.get_distance_m() *
						double(io.DeltaTime)));
	}
}

/// Middle button or Alt and left: orbit; with Shift: pan; wheel: nearer; right: look about and fly.
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
			r_viewport.camera.orbit(-drag.x * TURN_RAD_PER_PX, -drag.y * TURN_RAD_PER_PX);
		}
	}
	if (ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Right)) {
		if (drag != glm::dvec2(0.0)) {
			r_viewport.camera.turn(-drag.x * TURN_RAD_PER_PX, -drag.y * TURN_RAD_PER_PX);
		}
		fly(r_viewport);
	}
	if (p_is_hovered && io.MouseWheel != 0.0f) {
		r_viewport.camera.zoom(std::pow(ZOOM_PER_STEP, double(io.MouseWheel)));
	}
	if (r_viewport.camera.get_revision() != before) {
		r_viewport.is_moving = true;
		r_viewport.needs_picture = true;
	}
}

/// The radius at which the mouse now holds the handle of a circle, as far along the line from its
/// centre to the handle.
double compute_dragged_radius(double p_radius_m, double p_metres_per_px,
		const std::optional<ImVec2> &p_center, const ImVec2 &p_handle) {
	const ImGuiIO &io = ImGui::GetIO();
	const glm::dvec2 moved(io.MouseDelta.x, io.MouseDelta.y);
	const double SHORTEST_PX = 4.0; // below, the line says nothing: to the right is larger
	if (!p_center) {
		return p_radius_m + moved.x * p_metres_per_px;
	}
	const glm::dvec2 way(p_handle.x - p_center->x, p_handle.y - p_center->y);
	const double length_px = glm::length(way);
	if (length_px < SHORTEST_PX) {
		return p_radius_m + moved.x * p_metres_per_px;
	}
	return p_radius_m * (1.0 + glm::dot(moved, way) / (length_px * length_px));
}

/// The rings, discs and cones of the selected node's gizmo, and the handle that changes them.
void draw_gizmos(EditorContext &r_context, const ViewportProjection &p_projection) {
	Node3D *node = r_context.document.get_selected();
	if (node == nullptr) {
		return;
	}
	ImDrawList &list = *ImGui::GetWindowDrawList();
	const ImU32 color = IM_COL32(255, 200, 60, 255);
	const glm::dmat4 world_from_node = node->compute_world_from_node();
	for (int axis = 0; axis < 3; ++axis) {
		if (!(glm::length(glm::dvec3(world_from_node[axis])) > 0.0)) {
			return; // flat: it has no direction
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
			const double angle = 6.283185307179586 * side / SIDES;
			const glm::dvec3 place = center +
					gizmo.radius_m *
							(axes *
									(std::cos(angle) * gizmo.axis_x +
											std::sin(angle) * gizmo.axis_y));
			if (const std::optional<ImVec2> point = p_projection.project(place)) {
				points.push_back(*point);
			}
		}
		list.AddPolyline(points.data(), int(points.size()), color, ImDrawFlags_None, 2.0f);
		if (gizmo.is_filled) {
			list.AddConvexPolyFilled(points.data(), int(points.size()), IM_COL32(255, 200, 60, 50));
		}
		const std::optional<ImVec2> handle =
				p_projection.project(center + gizmo.radius_m * (axes * gizmo.axis_x));
		if (gizmo.property.empty() || !handle) {
			continue;
		}
		const float half = 7.0f;
		const ImGuiID id = ImGui::GetID(gizmo.property.c_str());
		if (id != r_context.dragged_handle && !p_projection.is_inside(*handle)) {
			continue;
		}
		list.AddCircleFilled(*handle, half, color);
		ImGui::SetCursorScreenPos(ImVec2(handle->x - half, handle->y - half));
		ImGui::PushID(gizmo.property.c_str());
		ImGui::InvisibleButton("handle", ImVec2(2 * half, 2 * half));
		r_context.note_item("handle " + gizmo.property);
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
			r_context.attempt(
					[&] { r_context.document.set_property(*node, gizmo.property, value, true); });
			r_context.viewport.is_moving = true;
		}
		if (ImGui::IsItemDeactivated()) {
			r_context.document.end_drag();
		}
		ImGui::PopID();
	}
}

void draw_view_choice(EditorContext &r_context) {
	ViewportState &viewport = r_context.viewport;
	ImGui::SetNextItemWidth(10.0f * ImGui::GetFontSize());
	const char *shown = viewport.debug_view.empty() ? "Picture" : viewport.debug_view.c_str();
	if (!ImGui::BeginCombo("##view", shown)) {
		return;
	}
	if (ImGui::Selectable("Picture", viewport.debug_view.empty())) {
		viewport.debug_view.clear();
		viewport.needs_picture = true;
	}
	std::vector<std::string> ids = r_context.shown.debug_views;
	if (ids.empty()) {
		ids.push_back("mask"); // the others are known once one was shown
	}
	for (const std::string &id : ids) {
		if (ImGui::Selectable(id.c_str(), viewport.debug_view == id)) {
			viewport.debug_view = id;
			viewport.needs_picture = true;
		}
	}
	ImGui::EndCombo();
}

} // namespace

void draw_viewport(EditorContext &r_context) {
	if (ImGui::Begin("Viewport", nullptr,
				PANEL_FLAGS | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse)) {
		draw_view_choice(r_context);
		const ImVec2 least = ImGui::GetCursorScreenPos();
		ImVec2 size = ImGui::GetContentRegionAvail();
		size = ImVec2(std::max(size.x, 16.0f), std::max(size.y, 16.0f));
		const glm::uvec2 size_px(static_cast<uint32_t>(size.x), static_cast<uint32_t>(size.y));
		if (size_px != r_context.viewport.size_px) {
			r_context.viewport.size_px = size_px;
			r_context.viewport.needs_picture = true;
		}
		if (r_context.picture != nullptr) {
			ImGui::Image(r_context.picture, size);
			ImGui::SetCursorScreenPos(least);
		}
		ImGui::InvisibleButton("viewport", size,
				ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle |
						ImGuiButtonFlags_MouseButtonRight);
		ImGui::SetItemAllowOverlap();
		r_context.note_item("viewport");
		move_camera(r_context.viewport, ImGui::IsItemHovered());
		draw_gizmos(r_context, ViewportProjection(r_context.viewport.camera, least, size));
	}
	ImGui::End();
}

} // namespace gnomon
