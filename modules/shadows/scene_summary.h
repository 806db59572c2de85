#pragma once

#include "modules/scene/scene_snapshot.h"
#include "modules/shadows/translucent_casters.h"

#include <cstdint>
#include <span>
#include <vector>

namespace gnomon {

/// What a frame needs to know of all instances of a scene. From frame to frame it is derived again
/// only for the pages of instances that have changed.
class SceneSummary {
public:
	/// Of one page of SceneSnapshot::instances.
	struct Page {
		Bounds bounds_world;
		Bounds caster_bounds_world;
		/// The caster whose bounds have the longest diagonal; null: there is no caster.
		const InstanceSnapshot *largest_caster = nullptr;
		double largest_diagonal_m = -1.0;
		Bounds other_caster_bounds_world; // of all but the largest
		uint64_t caster_triangle_count = 0;
		uint32_t posed_count = 0;
		uint32_t cut_block_count = 0; // casters with InstanceSnapshot::cut_block_size_px
		bool has_translucent_casters = false;
		bool may_scatter = false; // some material has a scatter above 0
	};

	SceneSummary() = default;
	explicit SceneSummary(const SharedVector<InstanceSnapshot> &p_instances) {
		update(p_instances);
	}
	void update(const SharedVector<InstanceSnapshot> &p_instances);

	std::span<const Page> get_pages() const { return pages; }
	const Bounds &get_bounds() const { return whole.bounds_world; }
	const Bounds &get_caster_bounds() const { return whole.caster_bounds_world; }
	/// Of all pages together.
	const Page &get_whole() const { return whole; }
	/// By instance: equal hashes mean equal shadows.
	std::span<const uint64_t> get_caster_hashes() const { return caster_hashes; }
	/// By instance.
	const CasterFlags &get_casters() const { return casts_shadow; }

private:
	Page derive_page(uint32_t p_page);

	SharedVector<InstanceSnapshot> instances; // of the last update
	std::vector<Page> pages;
	Page whole;
	std::vector<uint64_t> caster_hashes;
	CasterFlags casts_shadow;
};

} // namespace gnomon
