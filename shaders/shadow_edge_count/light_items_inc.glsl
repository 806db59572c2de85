// The light's faces, edges and trees.
#ifndef LIGHT_ITEMS_INC_GLSL
#define LIGHT_ITEMS_INC_GLSL

#include "shadow_edge_count/count_space_inc.glsl"
#include "shadow_edge_count/light_faces_inc.glsl"
#include "shadow_edge_count/light_trees_inc.glsl"

FETCHED_VEC4S(COUNT_BINDING_PLANES, planes_buffer);
FETCHED_UVEC4S(COUNT_BINDING_EDGES, edges_buffer);
FETCHED_VEC4S(COUNT_BINDING_NODES, nodes_buffer);
FETCHED_UINTS(COUNT_BINDING_CUT_FACES, cut_faces_buffer);
layout(constant_id = EDGE_COUNT_CONSTANT_MAY_CUT_DISC) const bool MAY_CUT_DISC = true;

vec4 load_count_plane(uint p_face) {
	return FETCH_VEC4(planes_buffer, limit_face(p_face));
}

CountEdgeRecord load_count_edge(uint p_index) {
	const uint first = 2u * min(p_index, max(light.max_edge_count, 1u) - 1u);
	return CountEdgeRecord(FETCH_UVEC4(edges_buffer, first), FETCH_UVEC4(edges_buffer, first + 1u));
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

/// True if the edge is of the LOD that receivers of a leaf with this distance see.
bool is_in_distance_range(float p_leaf_distance, CountEdgeRecord p_edge) {
	const vec2 distances = load_distances(p_edge.a_face0.w);
	return p_leaf_distance >= distances.x && p_leaf_distance < distances.y;
}

/// The number of faces that may cut the light's disc. 0 if no caster comes near it: then no pass has written a total.
uint find_cut_face_count() {
	return MAY_CUT_DISC ? min(totals[EDGE_COUNT_TOTAL_CUT_FACES], light.max_cut_face_count) : 0u;
}

CountNode load_count_node(CountTree p_tree, uint p_level, uint p_index) {
	const uint first = 2u * find_node_index(p_tree, p_level, p_index);
	return CountNode(FETCH_VEC4(nodes_buffer, first), FETCH_VEC4(nodes_buffer, first + 1u));
}

#endif
