// The faces that the way from a receiver to the light's centre crosses.
#ifndef COUNT_CROSSINGS_INC_GLSL
#define COUNT_CROSSINGS_INC_GLSL

#include "shadow_edge_count/count_space_inc.glsl"

/// Numbers of faces that the segment from a receiver to the light's centre crosses.
struct CountCrossings {
	int back_facing;	// faces of closed mesh parts that face the receiver, not the light
	int light_facing; // faces of closed mesh parts that face the light
	int double_sided;	// faces of double-sided mesh parts
};

/// Counts a face if the segment from the receiver to the light's centre crosses it. Its ends must be on different sides
/// of the face's plane. p_is_in_front: the receiver is in front of it, otherwise the light's centre is.
void count_face(CountReceiver p_receiver, CountFaceRecord p_face, bool p_is_in_front, inout CountCrossings r_found) {
	const vec2 a = count_offset(p_receiver, uintBitsToFloat(p_face.a_kind.xyz)).xy;
	const vec2 b = count_offset(p_receiver, uintBitsToFloat(p_face.b_first_distance.xyz)).xy;
	const vec2 c = count_offset(p_receiver, uintBitsToFloat(p_face.c_end_distance.xyz)).xy;
	const bool is_left = is_count_left(a, b);
	const bool is_crossed = is_left == is_count_left(b, c) && is_left == is_count_left(c, a) &&
			is_in_distance_range(p_receiver.leaf_distance, p_face);
	const bool is_open = p_face.a_kind.w != 0u;
	r_found.double_sided += is_crossed && is_open ? 1 : 0;
	r_found.back_facing += is_crossed && !is_open && p_is_in_front ? 1 : 0;
	r_found.light_facing += is_crossed && !is_open && !p_is_in_front ? 1 : 0;
}

/// The number of solids between a receiver and the light's centre. If the receiver is inside closed mesh parts, the
/// segment crosses more faces that face the light; if the light's centre is inside, it crosses more that face the
/// receiver. The larger number is that of the mesh parts that hide the light.
int sum_crossings(CountCrossings p_found) {
	return p_found.double_sided + max(p_found.back_facing, p_found.light_facing);
}

/// What counting edges needs to know of them.
struct CountSolids {
	int count; // see sum_crossings
	bool is_light_inside; // no fewer faces face the receiver than the light
};

CountSolids make_count_solids(CountCrossings p_found) {
	return CountSolids(sum_crossings(p_found), p_found.back_facing >= p_found.light_facing);
}

/// In one number that a half has exactly. The counters of points have no room for more solids.
float pack_solids(CountSolids p_solids) {
	return float(2 * clamp(p_solids.count, -900, 900) + (p_solids.is_light_inside ? 1 : 0));
}

CountSolids unpack_solids(float p_packed) {
	const int packed = int(p_packed);
	return CountSolids(packed >> 1, (packed & 1) != 0);
}

#endif
