#pragma once

#include "modules/scene/mesh.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace gnomon {

/// A bounding volume hierarchy over axis-aligned boxes, which finds the boxes in a region without
/// visiting all of them. Immutable once built, so that many threads may read it concurrently.
class Bvh {
public:
	struct Node {
		Bounds bounds;
		/// In a leaf: index of the first item in get_items(). Otherwise: index of the left child in
		/// get_nodes(); the right child follows it.
		uint32_t first = 0;
		uint32_t item_count = 0; // 0: not a leaf
	};

	Bvh() = default;
	/// Item i is p_boxes[i]. Empty boxes and boxes with NaN are skipped; infinite ones are allowed.
	explicit Bvh(std::span<const Bounds> p_boxes);

	/// Returns all nodes. The root is node 0, with at most 64 levels below it. Empty if there is no
	/// box.
	const std::vector<Node> &get_nodes() const { return nodes; }
	/// Returns the item indices in the order of the leaves.
	const std::vector<uint32_t> &get_items() const { return items; }

private:
	std::vector<Node> nodes;
	std::vector<uint32_t> items; // ordered by leaf
};

} // namespace gnomon
