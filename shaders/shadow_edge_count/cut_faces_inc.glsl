// Faces that may cut the light's disc as some receiver sees it. Each receiver tests all of them, so that no list
// of a texel has them: seen from so near they may fill half of the map, or none where they go through its centre.
#ifndef CUT_FACES_INC_GLSL
#define CUT_FACES_INC_GLSL

#include "shadow_edge_count/shadow_edge_count_shared.h"

/// True when the face's bounds come within R of the light's centre.
bool is_cut_face(CountLightConstants p_light, CountFaceRecord p_face) {
	const float WIDENED = 1.001; // for rounding
	const vec3 a = uintBitsToFloat(p_face.a_kind.xyz);
	const vec3 b = uintBitsToFloat(p_face.b.xyz);
	const vec3 c = uintBitsToFloat(p_face.c.xyz);
	const vec3 nearest = clamp(vec3(0.0), min(a, min(b, c)), max(a, max(b, c)));
	return p_light.most_cut_faces > 0u && length(nearest) <= WIDENED * p_light.disc_radius;
}

#endif
