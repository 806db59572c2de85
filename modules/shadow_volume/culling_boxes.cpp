#include "modules/shadow_volume/culling_boxes.h"

#include "modules/core/error.h"
#include "modules/mesh_tools/bvh.h"

namespace gnomon {

namespace {

shader::CullingBox make_box(
		const Bounds &p_bounds, const glm::dvec3 &p_origin, uint32_t p_first, uint32_t p_count) {
	return { glm::vec4(0.5 * (p_bounds.minimum + p_bounds.maximum) - p_origin, 0.0),
		glm::vec4(0.5 * (p_bounds.maximum - p_bounds.minimum), 0.0), p_first, p_count, 0, 0 };
}

/// Index of a subtree's first item: its items are contiguous, from the leftmost leaf on.
uint32_t find_first_item(const std::vector<Bvh::Node> &p_nodes, uint32_t p_node) {
	while (p_nodes[p_node].item_count == 0) {
		p_node = p_nodes[p_node].first;
	}
	return p_nodes[p_node].first;
}

} // namespace

CullingBoxes build_culling_boxes(
		std::span<const Bounds> p_boxes_world, const glm::dvec3 &p_origin_world) {
	const Bvh tree(p_boxes_world);
	const std::vector<Bvh::Node> &nodes = tree.get_nodes();
	CullingBoxes result;
	if (nodes.empty()) {
		return result;
	}
	struct Pending {
		uint32_t node;
		uint32_t end; // of its items
	};
	std::vector<Pending> pending = { { 0, static_cast<uint32_t>(tree.get_items().size()) } };
	while (!pending.empty()) {
		const auto [node, end] = pending.back();
		pending.pop_back();
		const uint32_t begin = find_first_item(nodes, node);
		if (nodes[node].item_count > 0 || end - begin <= CULLING_CASTERS_PER_SUBTREE) {
			GNOMON_ASSERT(end - begin <= CULLING_CASTERS_PER_SUBTREE, "a BVH leaf has ",
					end - begin, " boxes, at most ", CULLING_CASTERS_PER_SUBTREE, " fit a subtree");
			result.boxes.push_back(
					make_box(nodes[node].bounds, p_origin_world, begin, end - begin));
			continue;
		}
		const uint32_t left = nodes[node].first;
		const uint32_t middle = find_first_item(nodes, left + 1);
		pending.push_back({ left, middle });
		pending.push_back({ left + 1, end });
	}
	result.subtree_count = static_cast<uint32_t>(result.boxes.size());
	for (shader::CullingBox &subtree : result.boxes) {
		subtree.first += result.subtree_count;
	}
	for (const uint32_t item : tree.get_items()) {
		result.boxes.push_back(make_box(p_boxes_world[item], p_origin_world, item, 1));
	}
	return result;
}

} // namespace gnomon
