#pragma once

#include "modules/scene/mesh.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace gnomon {

/// A bounding volume hierarchy over boxes, to find those in a region without visiting all of them.
/// Immutable once built; many threads may read it concurrently.
class Bvh {
public:
	struct Node {
		Bounds bounds;
		uint32_t first =
				0; // leaf: into get_items(); otherwise the left child, the right one follows
		uint32_t item_count = 0; // 0 = has children
	};

	Bvh() = default;
	/// Item i is box i. Empty boxes and boxes with NaN are never found; infinite ones are allowed.
	explicit Bvh(std::span<const Bounds> p_boxes);

	/// The root is node 0; empty when there is no box. At most 64 levels are below it.
	const std::vector<Node> &get_nodes() const { return nodes; }
	const std::vector<uint32_t> &get_items() const { return items; }

private:
	std::vector<Node> nodes;
	std::vector<uint32_t> items; // ordered by leaf
};

} // namespace gnomon
