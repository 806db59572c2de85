// The light's trees over its faces and its edges, see CountNode, and walks through them.
#ifndef LIGHT_TREES_INC_GLSL
#define LIGHT_TREES_INC_GLSL

#include "shadow_edge_count/count_constants_inc.glsl"

layout(std430, set = 0, binding = COUNT_BINDING_TOTALS) readonly buffer Totals {
	uint totals[]; // EDGE_COUNT_TOTAL_*
};

/// The number of edges in the light's list.
uint find_edge_count() {
	return min(totals[EDGE_COUNT_TOTAL_EDGES], light.max_edge_count);
}

/// The number of nodes of a level of a tree over so many faces or edges.
uint find_node_count(uint p_item_count, uint p_level) {
	const uint shift = uint(findMSB(EDGE_COUNT_CLUSTER_SIZE)) + p_level * uint(findMSB(EDGE_COUNT_NODE_WIDTH));
	return (p_item_count + (1u << shift) - 1u) >> shift;
}

/// A tree over the light's faces or edges.
struct CountTree {
	uvec4 low_levels; // index of the first node of levels 0..3
	uvec4 high_levels;
	uint item_count; // faces or edges
	uint level_count;
};

CountTree make_count_tree(bool p_has_faces) {
	CountTree tree;
	tree.low_levels = p_has_faces ? light.face_levels[0] : light.edge_levels[0];
	tree.high_levels = p_has_faces ? light.face_levels[1] : light.edge_levels[1];
	tree.item_count = p_has_faces ? light.face_count : find_edge_count();
	tree.level_count = 1u;
	for (uint level = 1u; level < uint(EDGE_COUNT_MAX_LEVELS); ++level) {
		tree.level_count +=
				find_node_count(tree.item_count, level - 1u) > uint(EDGE_COUNT_NODE_WIDTH) ? 1u : 0u;
	}
	return tree;
}

/// Index of a node in the light's buffer of nodes.
uint find_node_index(CountTree p_tree, uint p_level, uint p_index) {
	const uvec4 levels = p_level < 4u ? p_tree.low_levels : p_tree.high_levels;
	const uvec2 pair = (p_level & 2u) == 0u ? levels.xy : levels.zw;
	return ((p_level & 1u) == 0u ? pair.x : pair.y) + p_index;
}

/// A position in the walk through a tree: the next node to test, before all that follow in depth-first order. No stack is
/// needed, as a node's level and index determine its parent.
struct TreeCursor {
	uint level;
	uint index;
	bool is_at_end;
};

TreeCursor start_cursor(CountTree p_tree) {
	return TreeCursor(p_tree.level_count - 1u, 0u, p_tree.item_count == 0u);
}

/// Goes to the first child of the node.
void descend_cursor(inout TreeCursor r_cursor) {
	--r_cursor.level;
	r_cursor.index *= uint(EDGE_COUNT_NODE_WIDTH);
}

/// Goes to the node with an index at the same level, or if that is not below the same parent or does not exist, to what
/// follows after the parent.
void advance_cursor(CountTree p_tree, uint p_index, inout TreeCursor r_cursor) {
	r_cursor.index = p_index;
	for (uint i = 0u; i < uint(EDGE_COUNT_MAX_LEVELS); ++i) {
		const bool is_past = r_cursor.index >= find_node_count(p_tree.item_count, r_cursor.level);
		const bool is_top = r_cursor.level + 1u >= p_tree.level_count;
		const bool is_up = !is_top && (is_past || r_cursor.index % uint(EDGE_COUNT_NODE_WIDTH) == 0u);
		r_cursor.is_at_end = r_cursor.is_at_end || (is_top && is_past);
		// The parent's next sibling: children of a parent that has none left end at its end, rounded up.
		r_cursor.index = is_up ? (r_cursor.index + uint(EDGE_COUNT_NODE_WIDTH) - 1u) / uint(EDGE_COUNT_NODE_WIDTH)
							   : r_cursor.index;
		r_cursor.level += is_up ? 1u : 0u;
	}
}

#endif
