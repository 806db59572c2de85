#include "modules/godot_addon/unknown_objects.h"

#include "modules/godot_addon/scene_body.h"

#include <algorithm>

namespace gnomon {

namespace {

// Reading the boxes of all nodes takes time, so that later frames are checked in groups: one to
// compare with the next, and two that must agree.
const uint64_t CHECK_INTERVAL = 60;
const uint64_t CHECKED_FRAMES = 3;

/// Whether a part of the box may be in view; the near and far planes are ignored.
bool may_see(const glm::dmat4 &p_clip_from_world, const Bounds &p_bounds) {
	int outside[5] = {};
	for (int corner = 0; corner < 8; ++corner) {
		const glm::dvec3 point((corner & 1) != 0 ? p_bounds.maximum.x : p_bounds.minimum.x,
				(corner & 2) != 0 ? p_bounds.maximum.y : p_bounds.minimum.y,
				(corner & 4) != 0 ? p_bounds.maximum.z : p_bounds.minimum.z);
		const glm::dvec4 clip = p_clip_from_world * glm::dvec4(point, 1.0);
		const bool is_outside[5] = { clip.x<-clip.w, clip.x> clip.w, clip.y<-clip.w, clip.y> clip.w,
			clip.w < 0 };
		for (int plane = 0; plane < 5; ++plane) {
			outside[plane] += int(is_outside[plane]);
		}
	}
	return std::none_of(outside, outside + 5, [](int p_count) { return p_count == 8; });
}

} // namespace

void UnknownObjects::begin_world(
		godot::RID p_scenario, const std::vector<ViewDetail> &p_views, uint64_t p_frame_number) {
	World &world = worlds.try_emplace(p_scenario, World{ p_frame_number, true }).first->second;
	world.is_used = true;
	const uint64_t age = p_frame_number - world.first_frame;
	checks = age < CHECK_INTERVAL || age % CHECK_INTERVAL < CHECKED_FRAMES;
	viewports.clear();
	for (const ViewDetail &view : p_views) {
		if (!checks) {
			counts.erase(view.viewport_id);
			continue;
		}
		viewports.push_back(view.viewport_id);
		ViewCount &count = counts[view.viewport_id];
		count.clip_from_world = view.clip_from_world;
		count.last_known = std::exchange(count.known, 0);
	}
}

void UnknownObjects::add(const Bounds &p_bounds_world, size_t p_count) {
	for (const uint64_t viewport : viewports) {
		ViewCount &count = counts[viewport];
		if (may_see(count.clip_from_world, p_bounds_world)) {
			count.known += int64_t(p_count);
		}
	}
}

void UnknownObjects::add(const godot::GeometryInstance3D &p_node, size_t p_count) {
	const godot::AABB box = get_culling_box(p_node);
	const glm::vec3 margin(static_cast<float>(p_node.get_extra_cull_margin()));
	add(transform_bounds({ box.position - margin, box.position + box.size + margin },
				get_drawn_transform(p_node).to_matrix()),
			p_count);
}

void UnknownObjects::add_everywhere(size_t p_count) {
	for (const uint64_t viewport : viewports) {
		counts[viewport].known += int64_t(p_count);
	}
}

int64_t UnknownObjects::end_world() {
	int64_t most = 0;
	for (const uint64_t id : viewports) {
		const godot::Viewport viewport(godot::get_instance(id));
		ViewCount &count = counts[id];
		const int64_t drawn = viewport.get_render_info(godot::Viewport::RENDER_INFO_TYPE_VISIBLE,
				godot::Viewport::RENDER_INFO_OBJECTS_IN_FRAME);
		// The numbers are of the last frame that the viewport drew.
		const int64_t unknown = count.last_known < 0 ? 0 : drawn - count.last_known;
		most = std::max(most, std::min(unknown, count.last_unknown));
		count.last_unknown = unknown;
	}
	return most;
}

void UnknownObjects::forget_unused() {
	std::erase_if(worlds, [](const auto &p_entry) { return !p_entry.second.is_used; });
	for (auto &[scenario, world] : worlds) {
		world.is_used = false;
	}
	std::erase_if(counts,
			[](const auto &p_entry) { return godot::get_instance(p_entry.first) == nullptr; });
}

} // namespace gnomon
