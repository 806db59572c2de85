// The light's constants and faces.
#ifndef LIGHT_FACES_INC_GLSL
#define LIGHT_FACES_INC_GLSL

#include "common/fetch_inc.glsl"
#include "shadow_edge_count/count_constants_inc.glsl"

FETCHED_UVEC4S(COUNT_BINDING_FACES, faces_buffer); // CountFaceRecord

uint limit_face(uint p_face) {
	return min(p_face, light.face_count - 1u);
}

/// Accessors limit their index to the capacity of the buffer, since it may come from a list.
CountFaceRecord load_count_face(uint p_face) {
	const uint first = 3u * limit_face(p_face);
	return CountFaceRecord(FETCH_UVEC4(faces_buffer, first), FETCH_UVEC4(faces_buffer, first + 1u),
			FETCH_UVEC4(faces_buffer, first + 2u));
}

/// The first and the end distance of a face's LOD, which is also that of its edges. p_face: index and flags.
vec2 load_distances(uint p_face) {
	const uint first = 3u * limit_face(p_face & EDGE_COUNT_FACE_MASK);
	return uintBitsToFloat(uvec2(FETCH_UVEC4(faces_buffer, first + 1u).w, FETCH_UVEC4(faces_buffer, first + 2u).w));
}

#endif
