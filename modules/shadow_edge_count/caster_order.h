#pragma once

#include "modules/scene/nodes.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace gnomon {

/// What the order of a light's casters depends on.
struct OrderedCaster {
	Bounds bounds_world;
	uint32_t edge_count = 0; // of its silhouette edges, or an estimate
};

/// The order of a light's casters, in which those whose edges share a node of a tree (see
/// CountNode) are close to each other, so that one test of the group's bounds
/// can reject them all. The order is cached, so that edges of casters that did not move are reused.
class CasterOrder {
public:
	/// Up to this number of casters are left as they are: their few groups are tested quickly.
	static constexpr size_t MAX_UNSORTED = 256;

	/// Returns indices into p_casters. They are those of the previous call, unless p_may_reuse is
	/// false, the number of casters has changed, or the groups have grown by half since the last
	/// sort; then casters are sorted along a Hilbert curve through their bounds' centres.
	const std::vector<uint32_t> &update(
			std::vector<OrderedCaster> p_casters, bool p_may_reuse = true);
	/// Moves casters: pairs of an index and new bounds. Returns false if the groups have grown by
	/// half; they are measured whenever a sixteenth of the casters have moved.
	bool move(std::span<const std::pair<uint32_t, Bounds>> p_moved);
	/// How often update() has sorted.
	uint32_t get_sort_count() const { return sort_count; }

private:
	bool has_grown() const;

	std::vector<OrderedCaster> casters; // of the last update
	std::vector<uint32_t> order;
	double sorted_area_m2 = 0; // of the groups after the last sort
	size_t moved_count = 0;	   // casters that moved since the groups were last measured
	uint32_t sort_count = 0;
};

/// The summed surface area of the bounds of casters that share a node of 512 edges, in square
/// metres. A measure of how many groups a receiver's shaft meets. p_order: indices into p_casters.
double sum_group_areas(std::span<const OrderedCaster> p_casters, std::span<const uint32_t> p_order);

} // namespace gnomon
