#pragma once

#include "modules/godot_addon/detail_levels.h"
#include "modules/scene/mesh.h"

#include <godot_api.gen.h>

#include <map>

namespace gnomon {

/// Finds whether Godot draws objects that exist only on the RenderingServer, such as the tiles of
/// terrain add-ons: whether a viewport draws more objects than the known ones in its view. Main
/// thread only.
class UnknownObjects {
public:
	/// Call once per frame and world. p_views: of the frame about to be drawn. p_frame_number:
	/// counts frames; a world's first 60 are checked, later three of 60.
	void begin_world(
			godot::RID p_scenario, const std::vector<ViewDetail> &p_views, uint64_t p_frame_number);
	/// Whether the nodes of this frame are to be added.
	bool is_checking() const { return checks; }
	/// Adds a node that Godot draws with p_count draw calls if its box is in view.
	void add(const godot::GeometryInstance3D &p_node, size_t p_count);
	/// Adds a box in the world.
	void add(const Bounds &p_bounds_world, size_t p_count);
	/// Adds objects whose bounds are not known.
	void add_everywhere(size_t p_count);
	/// Returns how many unknown objects were drawn in two frames in a row, in the view that has the
	/// most of them.
	int64_t end_world();
	/// Forgets viewports that were freed, and worlds that were not read. Call once per frame.
	void forget_unused();

private:
	struct ViewCount {
		glm::dmat4 clip_from_world = glm::dmat4(1.0);
		int64_t known = 0;		  // in the frame about to be drawn
		int64_t last_known = -1;  // in the frame before; negative: there was none
		int64_t last_unknown = 0; // in that frame
	};
	std::map<uint64_t, ViewCount> counts; // by viewport
	std::vector<uint64_t> viewports;	  // of the world; empty if this frame is not checked
	bool checks = false;
	struct World {
		uint64_t first_frame = 0;
		bool is_used = false; // in this frame
	};
	std::map<godot::RID, World> worlds; // by scenario
};

} // namespace gnomon
