// The light's faces, for the passes that list them. Those that may cut the light's disc as seen by some receiver have a
// list of their own: each receiver tests all of them, so they are in no texel's list. So close to
// the light a face may cover half of the map, or no texel if its plane contains the light's centre.
#ifndef LIGHT_FACES_INC_GLSL
#define LIGHT_FACES_INC_GLSL

#include "common/fetch_inc.glsl"
#include "shadow_edge_count/shadow_edge_count_shared.h"

FETCHED_UVEC4S(FACE_LIST_BINDING_FACES, faces_buffer); // CountFaceRecord

CountFaceRecord load_face(uint p_face) {
	const uint first = 3u * p_face;
	return CountFaceRecord(FETCH_UVEC4(faces_buffer, first), FETCH_UVEC4(faces_buffer, first + 1u),
			FETCH_UVEC4(faces_buffer, first + 2u));
}

/// True if the face's bounds come within R of the light's centre. Always false if no caster's
/// bounds do: then max_cut_face_count is 0.
bool is_cut_face(CountLightConstants p_light, CountFaceRecord p_face) {
	const float WIDENING = 1.001; // for rounding
	const vec3 a = uintBitsToFloat(p_face.a_kind.xyz);
	const vec3 b = uintBitsToFloat(p_face.b_first_distance.xyz);
	const vec3 c = uintBitsToFloat(p_face.c_end_distance.xyz);
	const vec3 nearest = clamp(vec3(0.0), min(a, min(b, c)), max(a, max(b, c)));
	return p_light.max_cut_face_count > 0u && length(nearest) <= WIDENING * p_light.disc_radius;
}

#endif
