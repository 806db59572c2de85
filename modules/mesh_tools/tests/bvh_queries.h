#pragma once

#include "modules/mesh_tools/bvh.h"

#include <doctest/doctest.h>

#include <algorithm>

namespace gnomon {

/// Runs queries on a Bvh over some boxes, for comparison with brute force.
class BvhQueries {
public:
	explicit BvhQueries(const std::vector<Bounds> &p_boxes) : boxes(p_boxes), tree(p_boxes) {}

	/// Returns the items whose box overlaps or touches p_box, in ascending order; none if p_box is
	/// empty or has NaN.
	std::vector<uint32_t> find_in_box(const Bounds &p_box) const {
		if (p_box.is_empty()) {
			return {};
		}
		return find([&](const Bounds &p_bounds) {
			return p_bounds.minimum.x <= p_box.maximum.x && p_box.minimum.x <= p_bounds.maximum.x &&
					p_bounds.minimum.y <= p_box.maximum.y &&
					p_box.minimum.y <= p_bounds.maximum.y &&
					p_bounds.minimum.z <= p_box.maximum.z && p_box.minimum.z <= p_bounds.maximum.z;
		});
	}
	/// Returns the items whose box is not completely behind one of the planes, in ascending order.
	/// A point q is in front of plane n if dot(n.xyz, q) + n.w >= 0.
	std::vector<uint32_t> find_in_planes(const std::vector<glm::dvec4> &p_planes) const {
		return find([&](const Bounds &p_bounds) {
			return std::all_of(p_planes.begin(), p_planes.end(),
					[&](const glm::dvec4 &p_plane) { return reaches_front(p_bounds, p_plane); });
		});
	}

private:
	/// One sibling for each of the 64 levels below the root, and the current node.
	static constexpr size_t MAX_STACK_SIZE = 65;

	/// Returns whether a part of the box is in front of the plane.
	static bool reaches_front(const Bounds &p_box, const glm::dvec4 &p_plane) {
		double side = p_plane.w;
		for (int axis = 0; axis < 3; ++axis) {
			if (p_plane[axis] != 0) { // 0 times infinity is not a number
				side += p_plane[axis] * (p_plane[axis] > 0 ? p_box.maximum : p_box.minimum)[axis];
			}
		}
		return !(side < 0);
	}

	template <typename Test> std::vector<uint32_t> find(const Test &p_test) const {
		std::vector<uint32_t> found;
		const std::vector<Bvh::Node> &nodes = tree.get_nodes();
		std::vector<uint32_t> stack;
		if (!nodes.empty()) {
			stack.push_back(0);
		}
		while (!stack.empty()) {
			REQUIRE(stack.size() <= MAX_STACK_SIZE);
			const Bvh::Node &node = nodes[stack.back()];
			stack.pop_back();
			if (!p_test(node.bounds)) {
				continue;
			}
			for (uint32_t index = node.first; index < node.first + node.item_count; ++index) {
				const uint32_t item = tree.get_items()[index];
				if (p_test(boxes[item])) {
					found.push_back(item);
				}
			}
			if (node.item_count == 0) {
				stack.push_back(node.first + 1);
				stack.push_back(node.first);
			}
		}
		std::sort(found.begin(), found.end());
		return found;
	}

	const std::vector<Bounds> boxes;
	const Bvh tree;
};

} // namespace gnomon
