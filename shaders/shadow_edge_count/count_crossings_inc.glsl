// The faces that the way from a receiver to the light's centre crosses.
#ifndef COUNT_CROSSINGS_INC_GLSL
#define COUNT_CROSSINGS_INC_GLSL

#include "shadow_edge_count/count_space_inc.glsl"

// Numbers of crossed faces are ivec3s: x faces of closed mesh parts that face the receiver, not the light; y faces of closed
// mesh parts that face the light; z faces of double-sided mesh parts.

/// p_count faces of one kind.
ivec3 make_crossings(bool p_is_double_sided, bool p_is_light_in_front, int p_count) {
	return p_is_double_sided ? ivec3(0, 0, p_count) : (p_is_light_in_front ? ivec3(0, p_count, 0) : ivec3(p_count, 0, 0));
}

/// 1 of its kind if the segment from the receiver to the light's centre crosses the face. The segment's ends must be on
/// different sides of the face's plane. p_is_in_front: the receiver is in front of it, otherwise the light's centre is.
ivec3 count_face(CountReceiver p_receiver, CountFaceRecord p_face, bool p_is_in_front) {
	const vec2 a = count_offset(p_receiver, uintBitsToFloat(p_face.a_kind.xyz)).xy;
	const vec2 b = count_offset(p_receiver, uintBitsToFloat(p_face.b_first_distance.xyz)).xy;
	const vec2 c = count_offset(p_receiver, uintBitsToFloat(p_face.c_end_distance.xyz)).xy;
	const bool is_left = is_count_left(a, b);
	const bool is_crossed = is_left == is_count_left(b, c) && is_left == is_count_left(c, a) &&
			is_in_distance_range(p_receiver.leaf_distance, p_face);
	return is_crossed ? make_crossings(p_face.a_kind.w != 0u, !p_is_in_front, 1) : ivec3(0);
}

/// The number of solids between a receiver and the light's centre. If the receiver is inside closed mesh parts, the
/// segment crosses more faces that face the light; if the light's centre is inside, it crosses more that face the
/// receiver. The larger number is that of the mesh parts that hide the light.
int sum_crossings(ivec3 p_found) {
	return p_found.z + max(p_found.x, p_found.y);
}

/// What counting edges needs to know of them, in a number that a half has exactly: twice the number of solids (the counters of
/// points have no room for more), plus 1 if the light's centre is inside closed parts: no fewer faces face the receiver than
/// the light.
int pack_solids(ivec3 p_found) {
	return 2 * clamp(sum_crossings(p_found), -900, 900) + (p_found.x >= p_found.y ? 1 : 0);
}

int unpack_solid_count(int p_solids) {
	return p_solids >> 1;
}

#endif
