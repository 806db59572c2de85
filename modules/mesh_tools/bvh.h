#pragma once

#include "modules/scene/mesh.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace gnomon {

/// A tree over boxes that finds those in a box or a frustum without looking at all of them. Built
/// once; many threads may query at the same time.
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

	/// Appends the items whose box shares at least a point with p_box, in ascending order. None for
	/// an empty box or one with NaN.
	void find_in_box(const Bounds &p_box, std::vector<uint32_t> &r_items) const;
	/// Appends the items whose box is not wholly behind one of the planes, in ascending order. A
	/// point q is in front of plane n when dot(n.xyz, q) + n.w >= 0. Any number of planes: six for
	/// a frustum, five without a far plane. A box near a corner may be found although it is
	/// outside.
	void find_in_planes(std::span<const glm::dvec4> p_planes, std::vector<uint32_t> &r_items) const;

	/// The root is node 0; empty when there is no box. For hierarchical culling.
	const std::vector<Node> &get_nodes() const { return nodes; }
	const std::vector<uint32_t> &get_items() const { return items; }

private:
	std::vector<Node> nodes;
	std::vector<uint32_t> items; // ordered by leaf
	std::vector<Bounds> boxes;	 // in the order of `items`

	template <typename Test> void find(const Test &p_test, std::vector<uint32_t> &r_items) const;
};

} // namespace gnomon
