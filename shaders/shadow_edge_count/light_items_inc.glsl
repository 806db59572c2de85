// The light's constants, and its faces, edges and trees.
#ifndef LIGHT_ITEMS_INC_GLSL
#define LIGHT_ITEMS_INC_GLSL

#include "common/fetch_inc.glsl"
#include "shadow_edge_count/count_constants_inc.glsl"
#include "shadow_edge_count/count_space_inc.glsl"
#include "shadow_edge_count/node_levels_inc.glsl"

FETCHED_UVEC4S(COUNT_BINDING_FACES, faces_buffer);
FETCHED_VEC4S(COUNT_BINDING_PLANES, planes_buffer);
FETCHED_UVEC4S(COUNT_BINDING_EDGES, edges_buffer);
FETCHED_VEC4S(COUNT_BINDING_NODES, nodes_buffer);
FETCHED_UINTS(COUNT_BINDING_CUT_FACES, cut_faces_buffer);
layout(std430, set = 0, binding = COUNT_BINDING_TOTALS) readonly buffer Totals {
	uint totals[]; // EDGE_COUNT_TOTAL_*
};
layout(constant_id = EDGE_COUNT_CONSTANT_MAY_CUT_DISC) const bool MAY_CUT_DISC = true;

uint limit_face(uint p_face) {
	return min(p_face, light.face_count - 1u);
}

/// Accessors limit their index to the capacity of the buffer, since it may come from a list.
CountFaceRecord load_count_face(uint p_face) {
	const int first = int(3u * limit_face(p_face));
	return CountFaceRecord(FETCH_UVEC4(faces_buffer, first), FETCH_UVEC4(faces_buffer, first + 1),
			FETCH_UVEC4(faces_buffer, first + 2));
}

vec4 load_count_plane(uint p_face) {
	return FETCH_VEC4(planes_buffer, limit_face(p_face));
}

CountEdgeRecord load_count_edge(uint p_index) {
	const int first = int(2u * min(p_index, max(light.max_edge_count, 1u) - 1u));
	return CountEdgeRecord(FETCH_UVEC4(edges_buffer, first), FETCH_UVEC4(edges_buffer, first + 1));
}

/// The planes of an edge's faces. If there is no second face, both return the first one's plane.
vec4 load_count_plane0(CountEdgeRecord p_edge) {
	return load_count_plane(p_edge.a_face0.w & EDGE_COUNT_FACE_MASK);
}
vec4 load_count_plane1(CountEdgeRecord p_edge) {
	return load_count_plane(
			(p_edge.b_face1.w == EDGE_COUNT_NO_FACE ? p_edge.a_face0.w : p_edge.b_face1.w) &
			EDGE_COUNT_FACE_MASK);
}

/// True if the edge is of the level of detail that receivers of a leaf with this distance see.
bool is_in_distance_range(float p_leaf_distance, CountEdgeRecord p_edge) {
	const int first = int(3u * limit_face(p_edge.a_face0.w & EDGE_COUNT_FACE_MASK));
	return p_leaf_distance >= uintBitsToFloat(FETCH_UVEC4(faces_buffer, first + 1).w) &&
			p_leaf_distance < uintBitsToFloat(FETCH_UVEC4(faces_buffer, first + 2).w);
}

/// The number of edges in the light's list.
uint find_edge_count() {
	return min(totals[EDGE_COUNT_TOTAL_EDGES], light.max_edge_count);
}

/// The number of faces that may cut the light's disc. 0 if no caster comes near it: then no pass has written a total.
uint find_cut_face_count() {
	return MAY_CUT_DISC ? min(totals[EDGE_COUNT_TOTAL_CUT_FACES], light.max_cut_face_count) : 0u;
}

uint load_cut_face(uint p_index) {
	return FETCH_UINT(cut_faces_buffer, p_index);
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

CountNode load_count_node(CountTree p_tree, uint p_level, uint p_index) {
	const uvec4 levels = p_level < 4u ? p_tree.low_levels : p_tree.high_levels;
	const uvec2 pair = (p_level & 2u) == 0u ? levels.xy : levels.zw;
	const int first = int(2u * (((p_level & 1u) == 0u ? pair.x : pair.y) + p_index));
	return CountNode(FETCH_VEC4(nodes_buffer, first), FETCH_VEC4(nodes_buffer, first + 1));
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
