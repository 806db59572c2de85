// The light's faces, and which of them may cut the light's disc as seen by some receiver.
#ifndef LIGHT_FACES_INC_GLSL
#define LIGHT_FACES_INC_GLSL

#include "common/fetch_inc.glsl"
#include "shadow_edge_count/shadow_edge_count_shared.h"

FETCHED_UVEC4S(CUT_FACES_BINDING_FACES, faces_buffer); // CountFaceRecord

CountFaceRecord load_face(uint p_face) {
	const uint first = 3u * p_face;
	return CountFaceRecord(FETCH_UVEC4(faces_buffer, first), FETCH_UVEC4(faces_buffer, first + 1u),
			FETCH_UVEC4(faces_buffer, first + 2u));
}

/// Squared distance of the light's centre from the segment between two points.
float find_square_distance(vec3 p_a, vec3 p_b) {
	const vec3 along = p_b - p_a;
	const float fraction = clamp(-dot(p_a, along) / max(dot(along, along), 1e-37), 0.0, 1.0);
	const vec3 nearest = p_a + fraction * along;
	return dot(nearest, nearest);
}

/// True if the face comes within R of the light's centre. Always false if no caster's bounds do:
/// then max_cut_face_count is 0.
bool is_cut_face(CountLightConstants p_light, CountFaceRecord p_face) {
	const float WIDENING = 1.001; // for rounding
	const vec3 a = uintBitsToFloat(p_face.a_kind.xyz);
	const vec3 b = uintBitsToFloat(p_face.b_first_distance.xyz);
	const vec3 c = uintBitsToFloat(p_face.c_end_distance.xyz);
	// Nearest is a point of a side, or the foot of the perpendicular if that is inside the face. The normal of a sliver
	// may be wrong, but the sliver's points are all near its sides.
	const float side_square = min(find_square_distance(a, b), min(find_square_distance(b, c), find_square_distance(c, a)));
	const vec3 normal = cross(b - a, c - a);
	const float normal_square = dot(normal, normal);
	const float height = dot(normal, a);
	const vec3 sides = vec3(dot(normal, cross(a, b)), dot(normal, cross(b, c)), dot(normal, cross(c, a)));
	const bool is_inside = all(greaterThanEqual(sides, vec3(0.0))) || all(lessThanEqual(sides, vec3(0.0)));
	const float plane_square = is_inside && normal_square > 1e-30 ? height * height / normal_square : side_square;
	const float radius = WIDENING * p_light.disc_radius;
	return p_light.max_cut_face_count > 0u && min(side_square, plane_square) <= radius * radius;
}

#endif
