#include "modules/godot_addon/view_visibility.h"

#include "modules/godot_addon/scene_body.h"

#include <algorithm>

namespace gnomon {

namespace {

using godot::GeometryInstance3D;

const int MAX_PARENTS = 64; // of visibility; more are a cycle

/// Returns the point whose distance to the camera Godot compares with the range.
glm::dvec3 find_center(const GeometryInstance3D &p_node) {
	const godot::AABB box = get_culling_box(p_node);
	const glm::dmat4 world_from_node = get_drawn_transform(p_node).to_matrix();
	return glm::dvec3(
			world_from_node * glm::dvec4(glm::dvec3(box.position + 0.5f * box.size), 1.0));
}

GeometryInstance3D find_parent(const GeometryInstance3D &p_node) {
	const godot::NodePath path = p_node.get_visibility_parent();
	return path.to_utf8().empty() ? GeometryInstance3D()
								  : godot::cast<GeometryInstance3D>(p_node.get_node_or_null(path));
}

} // namespace

bool ViewVisibility::has_range(const GeometryInstance3D &p_node) {
	return p_node.get_visibility_range_begin() > 0 || p_node.get_visibility_range_end() > 0 ||
			!p_node.get_visibility_parent().to_utf8().empty();
}

RangeState ViewVisibility::find_state(const GeometryInstance3D &p_node, const ViewDetail &p_view) {
	const double begin_m = p_node.get_visibility_range_begin();
	const double end_m = p_node.get_visibility_range_end();
	if (begin_m <= 0 && end_m <= 0) {
		return RangeState::VISIBLE;
	}
	const bool fades = p_node.get_visibility_range_fade_mode() !=
			GeometryInstance3D::VISIBILITY_RANGE_FADE_DISABLED;
	const double begin_margin_m = p_node.get_visibility_range_begin_margin();
	const double end_margin_m = p_node.get_visibility_range_end_margin();
	const double distance_m =
			glm::distance(glm::dvec3(p_view.camera.to_matrix()[3]), find_center(p_node));
	bool &was_drawn = drawn[{ godot::get_instance_id(p_node.get_object()), p_view.viewport_id }];
	// A node that fades is drawn on both sides of the limit. Without fading, a node changes its
	// state only beyond the margin.
	const double sign = fades || was_drawn ? 1.0 : -1.0;
	if (end_m > 0 && distance_m > end_m + sign * end_margin_m) {
		was_drawn = false;
		return RangeState::FARTHER;
	}
	if (begin_m > 0 && distance_m < begin_m - sign * begin_margin_m) {
		was_drawn = false;
		return RangeState::NEARER;
	}
	was_drawn = true;
	const bool is_in_margin = (end_m > 0 && distance_m > end_m - end_margin_m) ||
			(begin_m > 0 && distance_m < begin_m + begin_margin_m);
	return fades && is_in_margin ? RangeState::FADED : RangeState::VISIBLE;
}

RangeState ViewVisibility::find_state_with_parent(
		const GeometryInstance3D &p_node, const ViewDetail &p_view) {
	RangeState state = find_state(p_node, p_view);
	GeometryInstance3D parent = find_parent(p_node);
	for (int depth = 0; parent && depth < MAX_PARENTS; ++depth) {
		// A child is drawn where its parent is not, because the camera is near.
		const RangeState of_parent = find_state(parent, p_view);
		const bool fades_children = of_parent == RangeState::FADED &&
				parent.get_visibility_range_fade_mode() ==
						GeometryInstance3D::VISIBILITY_RANGE_FADE_DEPENDENCIES;
		if (of_parent != RangeState::NEARER && !fades_children) {
			return RangeState::FARTHER;
		}
		state = fades_children && state == RangeState::VISIBLE ? RangeState::FADED : state;
		parent = find_parent(parent);
	}
	return state;
}

bool ViewVisibility::is_faded(const GeometryInstance3D &p_node) {
	return std::any_of(views->begin(), views->end(), [&](const ViewDetail &p_view) {
		return find_state_with_parent(p_node, p_view) == RangeState::FADED;
	});
}

void ViewVisibility::hide(const GeometryInstance3D &p_node, size_t p_first, size_t p_last) {
	for (ViewDetail &view : *views) {
		const RangeState state = find_state_with_parent(p_node, view);
		if (state == RangeState::NEARER || state == RangeState::FARTHER) {
			for (size_t instance = p_first; instance < p_last; ++instance) {
				view.hidden_instances.push_back(instance);
			}
		}
	}
}

void ViewVisibility::forget_unused() {
	std::erase_if(drawn, [](const auto &p_entry) {
		return godot::get_instance(p_entry.first.first) == nullptr ||
				godot::get_instance(p_entry.first.second) == nullptr;
	});
}

} // namespace gnomon
