// The numbers of faces between a receiver and the light's centre, from those of another receiver of the leaf, the anchor.
//
// Sweep the way to the light's centre O from the anchor A to the receiver P. The number of crossed faces of one kind
// (see count_crossings_inc.glsl; it depends on which side of a face O is, so it is the same for A and P) changes
// - where the triangle (O, A, P) meets an edge of such a face. Those of the edge's two faces cancel each other unless
//   the edge is a silhouette as seen from O, or a boundary;
// - where A-P crosses a face.
// An edge (a, b) meets the triangle if A and P are on different sides of the plane (O, a, b), a and b on different sides
// of the plane (O, A, P), and P on the side of the plane (a, b, A) on which O is not. Each predicate is the sign of a
// float with an error bound. If a sign that matters is not certain, the receiver is undecided: then all faces on its own
// way are tested (count_along_ray).
#ifndef COUNT_SWEEP_INC_GLSL
#define COUNT_SWEEP_INC_GLSL

#include "shadow_edge_count/count_classify_inc.glsl"
#include "shadow_edge_count/count_crossings_inc.glsl"
#include "shadow_edge_count/count_status_inc.glsl"
#include "shadow_edge_count/light_items_inc.glsl"

/// The sign of a value, or 0 if it is not certain. p_error: bound of the value's rounding error.
int find_certain_sign(float p_value, float p_error) {
	return p_value > p_error ? 1 : (p_value < -p_error ? -1 : 0);
}

/// The change across an edge, for a receiver that has the light's centre to the left of it (is_count_left); 0 if the
/// edge is no silhouette as seen from the centre.
ivec3 find_edge_change(CountEdgeRecord p_edge) {
	const CountEdgeKind kind = make_count_kind(p_edge.a_face0.w, p_edge.b_face1.w);
	const bool is_front0 = is_count_light_in_front(load_count_plane0(p_edge));
	const bool is_front1 = is_count_light_in_front(load_count_plane1(p_edge));
	const ivec3 first = make_crossings(kind.is_double_sided, is_front0, is_front0 ? -1 : 1);
	const ivec3 second = make_crossings(kind.is_double_sided, is_front1, kind.is_inconsistent == is_front1 ? -1 : 1);
	return first + (kind.has_face1 ? second : ivec3(0));
}

const float SWEEP_ROUNDING = 6e-7; // of products of two or three lengths
const float SIDE_ROUNDING = 4e-7;  // of the distance from a plane, in lengths

/// is_count_left: 1, -1 for false, 0 if it is not certain.
int find_left_sign(CountReceiver p_receiver, vec3 p_a, vec3 p_b) {
	const vec2 a = count_offset(p_receiver, p_a).xy;
	const vec2 b = count_offset(p_receiver, p_b).xy;
	// The lengths of which count_offset computes dot products.
	const float length_a = min(length(p_a - p_receiver.position), IS_DIRECTIONAL ? COUNT_FAR : length(p_a));
	const float length_b = min(length(p_b - p_receiver.position), IS_DIRECTIONAL ? COUNT_FAR : length(p_b));
	return find_certain_sign(count_cross(a, b), SWEEP_ROUNDING * (length_a * length(b) + length_b * length(a)));
}

/// An edge or a face's side, prepared for sweeps from an anchor.
struct SweptEdge {
	vec3 a; // relative to the anchor
	vec3 b;
	vec3 normal; // of the plane (a, b, anchor), not normalised
	float lengths; // product of the lengths of a and b
};

SweptEdge make_swept_edge(vec3 p_anchor, vec3 p_a, vec3 p_b) {
	const vec3 a = p_a - p_anchor;
	const vec3 b = p_b - p_anchor;
	return SweptEdge(a, b, cross(a, b), length(a) * length(b));
}

/// A way from the anchor to a receiver.
struct Sweep {
	vec3 to_receiver;
	vec3 normal; // of the plane (O, anchor, receiver), not normalised
	float size; // of the terms of the normal
};

Sweep make_sweep(vec3 p_anchor, vec3 p_receiver) {
	const vec3 to_receiver = p_receiver - p_anchor;
	const float way = length(to_receiver);
	return IS_DIRECTIONAL ? Sweep(to_receiver, vec3(to_receiver.y, -to_receiver.x, 0.0), way)
						  : Sweep(to_receiver, cross(p_anchor, to_receiver), length(p_anchor) * way);
}

/// The side of the edge's plane on which the receiver is.
int find_line_sign(Sweep p_sweep, vec3 p_normal, float p_lengths) {
	return find_certain_sign(
			dot(p_sweep.to_receiver, p_normal), SWEEP_ROUNDING * length(p_sweep.to_receiver) * p_lengths);
}

/// 1 if the triangle of the sweep meets the edge with the receiver to its left, -1 if to its right, 0 if it does not
/// meet it. p_left_of_anchor: find_left_sign at the anchor.
int find_edge_crossing(
		Sweep p_sweep, SweptEdge p_edge, int p_left_of_anchor, int p_left, inout bool r_is_undecided) {
	const int side_a = find_certain_sign(dot(p_sweep.normal, p_edge.a), SWEEP_ROUNDING * p_sweep.size * length(p_edge.a));
	const int side_b = find_certain_sign(dot(p_sweep.normal, p_edge.b), SWEEP_ROUNDING * p_sweep.size * length(p_edge.b));
	const int line = find_line_sign(p_sweep, p_edge.normal, p_edge.lengths);
	const bool is_apart = (p_left_of_anchor != 0 && p_left_of_anchor == p_left) || (side_a != 0 && side_a == side_b) ||
			(line != 0 && (line == p_left || line == -p_left_of_anchor));
	const bool is_certain = p_left_of_anchor != 0 && p_left != 0 && side_a != 0 && side_b != 0 && line != 0;
	r_is_undecided = r_is_undecided || (!is_apart && !is_certain);
	return is_apart ? 0 : p_left;
}

/// The side of a face's plane: 1 in front, -1 behind, 0 if it is not certain.
int find_side_sign(vec4 p_plane, vec3 p_point) {
	precise const float side = p_plane.x * p_point.x + p_plane.y * p_point.y + p_plane.z * p_point.z + p_plane.w;
	return find_certain_sign(side, SIDE_ROUNDING * (length(p_point) + abs(p_plane.w)));
}

/// The change where the way from the anchor to the receiver crosses a face.
ivec3 find_face_change(vec3 p_anchor, vec3 p_receiver, Sweep p_sweep, CountFaceRecord p_face, vec4 p_plane,
		inout bool r_is_undecided) {
	const vec3 a = uintBitsToFloat(p_face.a_kind.xyz) - p_anchor;
	const vec3 b = uintBitsToFloat(p_face.b_first_distance.xyz) - p_anchor;
	const vec3 c = uintBitsToFloat(p_face.c_end_distance.xyz) - p_anchor;
	const vec3 lengths = vec3(length(a), length(b), length(c));
	const int from = find_side_sign(p_plane, p_anchor);
	const int to = find_side_sign(p_plane, p_receiver);
	const int ab = find_line_sign(p_sweep, cross(a, b), lengths.x * lengths.y);
	const int bc = find_line_sign(p_sweep, cross(b, c), lengths.y * lengths.z);
	const int ca = find_line_sign(p_sweep, cross(c, a), lengths.z * lengths.x);
	// Two signs that are certain and differ.
	const bool is_apart = (from != 0 && from == to) || ab * bc < 0 || bc * ca < 0 || ca * ab < 0;
	const bool is_certain = from != 0 && to != 0 && ab != 0 && bc != 0 && ca != 0;
	r_is_undecided = r_is_undecided || (!is_apart && !is_certain);
	const bool is_light_in_front = is_count_light_in_front(p_plane);
	return is_apart ? ivec3(0)
					: make_crossings(p_face.a_kind.w != 0u, is_light_in_front, (to > 0) != is_light_in_front ? 1 : -1);
}

/// True if the way from a point to the light's centre may meet a node's box.
bool is_node_on_way(vec3 p_point, CountNode p_node) {
	const float ROUNDING = 1e-6;
	const vec3 half_size = p_node.half_size_end_distance.xyz;
	if (IS_DIRECTIONAL) {
		const vec3 offset = p_point - p_node.center_first_distance.xyz;
		return all(lessThanEqual(abs(offset.xy), half_size.xy)) && offset.z >= -half_size.z;
	}
	// Separating axes of the box and the segment: those of the box, and their products with the segment's direction.
	const vec3 along = 0.5 * p_point; // half the segment
	const vec3 offset = along - p_node.center_first_distance.xyz; // of the middles
	const vec3 reach = abs(along);
	const vec3 slack = vec3(ROUNDING) * (abs(offset) + reach);
	const vec3 turned = abs(cross(offset, along));
	const vec3 limit = half_size.yzx * reach.zxy + half_size.zxy * reach.yzx +
			ROUNDING * (abs(offset).yzx * reach.zxy + abs(offset).zxy * reach.yzx);
	return all(lessThanEqual(abs(offset), half_size + reach + slack)) && all(lessThanEqual(turned, limit));
}

/// Tests all faces on the way to the light's centre. Invocations with p_is_active false return 0.
ivec3 count_along_ray(CountReceiver p_receiver, bool p_is_active) {
	const CountTree tree = make_count_tree(/*p_has_faces=*/true);
	TreeCursor cursor = start_cursor(tree);
	ivec3 found = ivec3(0);
	// Each node is tested once at most: there are fewer than 1.25 for each cluster.
	uint steps_left = 2u * find_node_count(tree.item_count, 0u) + uint(EDGE_COUNT_MAX_LEVELS);
	cursor.is_at_end = cursor.is_at_end || !p_is_active;
	while (!cursor.is_at_end && steps_left > 0u) {
		const CountNode node = load_count_node(tree, cursor.level, cursor.index);
		const bool is_met =
				is_node_on_way(p_receiver.position, node) && is_in_distance_range(p_receiver.leaf_distance, node);
		const uint first = cursor.index * uint(EDGE_COUNT_CLUSTER_SIZE);
		const uint end = is_met && cursor.level == 0u ? min(first + uint(EDGE_COUNT_CLUSTER_SIZE), tree.item_count) : 0u;
		for (uint face = first; face < end; ++face) {
			const vec4 plane = load_count_plane(face);
			const bool is_in_front = is_count_in_front(plane, p_receiver.position);
			if (is_in_front != is_count_light_in_front(plane)) {
				found += count_face(p_receiver, load_count_face(face), is_in_front);
			}
		}
		if (is_met && cursor.level > 0u) {
			descend_cursor(cursor);
		} else {
			advance_cursor(tree, cursor.index + 1u, cursor);
		}
		--steps_left;
	}
	note_fault(!cursor.is_at_end, EDGE_COUNT_FAULT_TREE);
	return found;
}

#endif
