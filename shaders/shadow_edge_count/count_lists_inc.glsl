// Access to the light's faces, and to the face lists of texels. The includer must declare `light` first.
#ifndef COUNT_LISTS_INC_GLSL
#define COUNT_LISTS_INC_GLSL

#include "shadow_edge_count/count_faces_inc.glsl"
#include "common/fetch_inc.glsl"

FETCHED_UINTS(COUNT_BINDING_HEADS, heads_buffer);
FETCHED_UVEC2S(COUNT_BINDING_NODES, nodes_buffer);
FETCHED_UVEC4S(COUNT_BINDING_FACES, faces_buffer);
FETCHED_VEC4S(COUNT_BINDING_PLANES, planes_buffer);
FETCHED_UINTS(COUNT_BINDING_CUT_FACES, cut_faces_buffer);
layout(std430, set = 0, binding = COUNT_BINDING_TOTALS) readonly buffer Totals {
	uint totals[]; // EDGE_COUNT_TOTAL_*
};

uint load_count_head(uint p_index) {
	return FETCH_UINT(heads_buffer, p_index);
}

uvec2 load_count_node(uint p_index) {
	return FETCH_UVEC2(nodes_buffer, p_index);
}

uint load_count_level(uint p_view) {
	return totals[EDGE_COUNT_TOTAL_LEVELS + p_view];
}

uint limit_face(uint p_face) {
	return min(p_face, light.face_count - 1u);
}

CountFaceRecord load_count_face(uint p_face) {
	const int first = int(3u * limit_face(p_face));
	return CountFaceRecord(FETCH_UVEC4(faces_buffer, first), FETCH_UVEC4(faces_buffer, first + 1),
			FETCH_UVEC4(faces_buffer, first + 2));
}

vec4 load_count_plane(uint p_face) {
	return FETCH_VEC4(planes_buffer, limit_face(p_face));
}

layout(constant_id = EDGE_COUNT_CONSTANT_MAY_CUT_DISC) const bool MAY_CUT_DISC = true;

/// The number of faces that may cut the light's disc. 0 if no caster comes near it: then no pass has written a total.
uint find_cut_face_count() {
	return MAY_CUT_DISC ? min(totals[EDGE_COUNT_TOTAL_CUT_FACES], light.max_cut_face_count) : 0u;
}

uint load_cut_face(uint p_index) {
	return FETCH_UINT(cut_faces_buffer, p_index);
}

#endif
