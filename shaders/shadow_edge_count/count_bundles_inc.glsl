// Access to the light's edges and their bundles. The includer must declare `light` first.
#ifndef COUNT_BUNDLES_INC_GLSL
#define COUNT_BUNDLES_INC_GLSL

#include "shadow_edge_count/count_box_inc.glsl"
#include "shadow_edge_count/count_lists_inc.glsl"

FETCHED_UVEC4S(COUNT_BINDING_EDGES, edges_buffer);
FETCHED_VEC4S(COUNT_BINDING_BUNDLES, bundles_buffer);

/// p_index: what a list has, limited to the capacity of the light's edges.
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

/// True if the edge is of the level of detail that receivers of a part with this distance see.
bool is_in_distance_range(float p_part_distance, CountEdgeRecord p_edge) {
	const int first = int(3u * limit_face(p_edge.a_face0.w & EDGE_COUNT_FACE_MASK));
	return p_part_distance >= uintBitsToFloat(FETCH_UVEC4(faces_buffer, first + 1).w) &&
			p_part_distance < uintBitsToFloat(FETCH_UVEC4(faces_buffer, first + 2).w);
}

/// p_index: of a bundle, or CountLightConstants::max_bundle_count plus the index of a group of bundles.
CountEdgeBundle load_count_bundle(uint p_index) {
	const int first = int(2u * p_index);
	return CountEdgeBundle(FETCH_VEC4(bundles_buffer, first), FETCH_VEC4(bundles_buffer, first + 1));
}

/// The number of edges in the light's list.
uint find_edge_count() {
	return min(totals[EDGE_COUNT_TOTAL_EDGES], light.max_edge_count);
}

uint find_bundle_count(uint p_edge_count) {
	return (p_edge_count + uint(EDGE_COUNT_BUNDLE_SIZE) - 1u) / uint(EDGE_COUNT_BUNDLE_SIZE);
}

#endif
