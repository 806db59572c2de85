#pragma once

#include "modules/godot_addon/detail_levels.h"

#include <godot_api.gen.h>

#include <map>

namespace gnomon {

/// How Godot draws a node at its distance from a camera (visibility ranges).
enum class RangeState {
	VISIBLE,
	FADED,	// drawn transparent, in the margin of its range
	NEARER, // hidden: the camera is nearer than the range
	FARTHER // hidden: the camera is farther than the range
};

/// The visibility ranges of nodes, and their visibility parents, in each view. Main thread only.
class ViewVisibility {
public:
	/// Call once per frame and world, with its views.
	void begin_world(std::vector<ViewDetail> &r_views) { views = &r_views; }
	/// Whether the node has a visibility range or parent. The other functions need not be called
	/// for nodes that have none.
	static bool has_range(const godot::GeometryInstance3D &p_node);
	/// Whether a view draws the node transparent.
	bool is_faded(const godot::GeometryInstance3D &p_node);
	/// Makes the instances from p_first to p_last - 1, which are the node's, cast nothing in the
	/// views that do not draw it.
	void hide(const godot::GeometryInstance3D &p_node, size_t p_first, size_t p_last);
	/// Removes the states of freed nodes. Call once per frame.
	void forget_unused();

private:
	RangeState find_state(const godot::GeometryInstance3D &p_node, const ViewDetail &p_view);
	RangeState find_state_with_parent(
			const godot::GeometryInstance3D &p_node, const ViewDetail &p_view);

	std::vector<ViewDetail> *views = nullptr;
	/// Nodes that were drawn in a view in the last frame; by the ids of the node and the viewport.
	std::map<std::pair<uint64_t, uint64_t>, bool> drawn;
};

} // namespace gnomon
