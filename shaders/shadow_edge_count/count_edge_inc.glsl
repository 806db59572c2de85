// The contribution of one edge to a receiver's counts, and the resulting visibility: the float32
// version of compute_count_visibility in modules/shadow_edge_count/count_in_double.h.
#ifndef COUNT_EDGE_INC_GLSL
#define COUNT_EDGE_INC_GLSL

#include "shadow_edge_count/count_classify_inc.glsl"
#include "shadow_edge_count/count_masks_inc.glsl"

/// The counts of a receiver so far.
struct CountState {
	int solid_count; // between the receiver and the light's centre
	uint edge_count; // edges that were counted
	// Signed area of the disc behind edges, in AREA_UNIT of the disc's area: a sum of integers, so that it does not depend
	// on the order of the edges. It wraps around, but the sum of all is below 512 discs.
	int area;
	int surplus;	 // to subtract from all counters: subtracting at some points is done by adding at all others
	PointCounters counters0;
	PointCounters counters1; // of the other sample sets; unused if there is one, and on GPUs
	PointCounters counters2;
	PointCounters counters3;
};

const float AREA_UNIT = 1.0 / 4194304.0; // 2^-22

CountState make_count_state(int p_solid_count) {
	const PointCounters zero = make_point_counters();
	return CountState(p_solid_count, 0u, 0, 0, zero, zero, zero, zero);
}

/// Two regions of the light's disc, component by component. Each is beyond a line, and between two directions
/// counter-clockwise.
struct CountSectors {
	vec2 area;		  // signed, in units of AREA_UNIT
	uvec2 mask_index; // of the points beyond the line, see find_count_mask_indices
	vec2 from_angle;  // see find_count_angles
	vec2 to_angle;
	// All bits are set, or none. flip: subtract, by adding at all other points. once, twice: how much to add.
	uvec2 flip;
	uvec2 once;
	uvec2 twice;
};

/// All bits set, or none.
uvec2 make_bit_masks(bvec2 p_are_set) {
	return uvec2(p_are_set.x ? 0xffffffffu : 0u, p_are_set.y ? 0xffffffffu : 0u);
}

/// Two edges in the disc's plane, component by component, each from a to b. Units of R.
struct DiscEdges {
	vec2 a_x;
	vec2 a_y;
	vec2 b_x;
	vec2 b_y;
};

/// The regions of the disc beyond two edges, seen from the disc's centre: circular sectors without their triangles.
/// p_are_left: see is_count_left. p_weights: 0, 1 or 2. A region is empty unless p_are_valid. Without branches, since
/// software drivers execute both sides.
CountSectors make_count_sectors(DiscEdges p_edges, bvec2 p_are_left, ivec2 p_weights, bvec2 p_are_valid) {
	const vec2 along_x = p_edges.b_x - p_edges.a_x;
	const vec2 along_y = p_edges.b_y - p_edges.a_y;
	const vec2 square = along_x * along_x + along_y * along_y;
	const vec2 inverse_length = inversesqrt(max(square, vec2(1e-37)));
	const vec2 u_x = along_x * inverse_length;
	const vec2 u_y = along_y * inverse_length;
	precise const vec2 cross_a = p_edges.a_x * u_y - p_edges.a_y * u_x;
	const vec2 offset = max(abs(cross_a), vec2(1e-20)); // of the line from the centre
	const vec2 half_chord = sqrt(max(1.0 - offset * offset, vec2(0.0)));
	const vec2 from = max(p_edges.a_x * u_x + p_edges.a_y * u_y, -half_chord);
	const vec2 to = min(p_edges.b_x * u_x + p_edges.b_y * u_y, half_chord);
	const vec2 length_along = to - from;
	// A sector's angle, from one arc tangent. from and to are measured from the foot of the perpendicular from the
	// centre, which avoids cancellation.
	const vec2 angle = count_half_angles(offset * offset + from * to, offset * length_along);
	const vec2 twice_area = angle - offset * length_along;
	const bvec2 are_valid = bvec2(
			p_are_valid.x && square.x >= 1e-16 && offset.x < 1.0 && length_along.x > 0.0,
			p_are_valid.y && square.y >= 1e-16 && offset.y < 1.0 && length_along.y > 0.0);
	CountSectors sectors;
	const vec2 weights = vec2(p_weights);
	const float UNITS = 0.5 / (COUNT_PI * AREA_UNIT);
	sectors.area = mix(vec2(0.0), mix(weights, -weights, p_are_left) * (UNITS * twice_area), are_valid);
	// The line's normal is (u_y, -u_x) or, on the other side, its opposite, whose quarter turn is against u.
	const vec2 middle = 0.5 * (from + to);
	sectors.mask_index = find_count_mask_indices(mix(-u_y, u_y, p_are_left), mix(u_x, -u_x, p_are_left), offset,
			mix(-middle, middle, p_are_left));
	const vec2 angle_a = find_count_angles(p_edges.a_x, p_edges.a_y);
	const vec2 angle_b = find_count_angles(p_edges.b_x, p_edges.b_y);
	sectors.from_angle = mix(angle_b, angle_a, p_are_left);
	sectors.to_angle = mix(angle_a, angle_b, p_are_left);
	sectors.flip = make_bit_masks(p_are_left);
	sectors.once = make_bit_masks(bvec2(are_valid.x && p_weights.x != 2, are_valid.y && p_weights.y != 2));
	sectors.twice = make_bit_masks(bvec2(are_valid.x && p_weights.x == 2, are_valid.y && p_weights.y == 2));
	return sectors;
}

/// The points of one sample set at which a sector adds.
uvec2 find_sector_points(float p_from_angle, float p_to_angle, uint p_flip, uvec2 p_mask, uint p_sample_set) {
	return (p_mask & find_count_wedge(p_from_angle, p_to_angle, p_sample_set)) ^ p_flip;
}

void count_sample_set(
		CountSectors p_sectors, uvec2 p_mask0, uvec2 p_mask1, uint p_sample_set, inout PointCounters r_counters) {
	const uvec2 first = find_sector_points(
			p_sectors.from_angle.x, p_sectors.to_angle.x, p_sectors.flip.x, p_mask0, p_sample_set);
	const uvec2 second = find_sector_points(
			p_sectors.from_angle.y, p_sectors.to_angle.y, p_sectors.flip.y, p_mask1, p_sample_set);
	add_masks(r_counters, first & p_sectors.once.x, second & p_sectors.once.y, first & p_sectors.twice.x,
			second & p_sectors.twice.y);
}

/// What flipped sectors add to all counters in excess.
int find_surplus(CountSectors p_sectors) {
	const uvec2 surplus = (p_sectors.flip & p_sectors.once & 1u) + (p_sectors.flip & p_sectors.twice & 2u);
	return int(surplus.x + surplus.y);
}

/// The area of two sectors as an integer, see CountState.
int round_area(CountSectors p_sectors) {
	const ivec2 area = ivec2(floor(p_sectors.area + 0.5));
	return area.x + area.y;
}

/// Adds the areas and points of two sectors: two at a time need half as many carries. Without branches, since software
/// drivers copy all counters where the sides of a branch join.
void count_sectors(CountSectors p_sectors, inout CountState r_state) {
	r_state.area += round_area(p_sectors);
	r_state.surplus += find_surplus(p_sectors);
	const uvec4 first0 = load_count_masks(p_sectors.mask_index.x, 0u);
	const uvec4 second0 = load_count_masks(p_sectors.mask_index.y, 0u);
	count_sample_set(p_sectors, first0.xy, second0.xy, 0u, r_state.counters0);
	if (SETS_PER_LANE == 4u) {
		const uvec4 first1 = load_count_masks(p_sectors.mask_index.x, 1u);
		const uvec4 second1 = load_count_masks(p_sectors.mask_index.y, 1u);
		count_sample_set(p_sectors, first0.zw, second0.zw, 1u, r_state.counters1);
		count_sample_set(p_sectors, first1.xy, second1.xy, 2u, r_state.counters2);
		count_sample_set(p_sectors, first1.zw, second1.zw, 3u, r_state.counters3);
	}
}

/// Moves the ends of two segments of (X, d), component by component, along them until d is in p_min..p_max. The result
/// is meaningless for a segment that has no such point. r_x, r_y, r_d: the ends. p_inverse: 1 / (p_other_d - r_d).
void cut_count_offsets(vec2 p_other_x, vec2 p_other_y, vec2 p_inverse, float p_min, float p_max, inout vec2 r_x,
		inout vec2 r_y, inout vec2 r_d) {
	const vec2 d = clamp(r_d, p_min, p_max);
	const vec2 fraction = (d - r_d) * p_inverse;
	const bvec2 is_cut = notEqual(d, r_d);
	r_x = mix(r_x, mix(r_x, p_other_x, fraction), is_cut);
	r_y = mix(r_y, mix(r_y, p_other_y, fraction), is_cut);
	r_d = d;
}

/// An edge from a to b in light space, and its weight as seen by the receiver; 0: none.
struct CountedEdge {
	vec3 a;
	vec3 b;
	int weight;
};

/// The regions of the light beyond two edges. That of an edge with weight 0 is empty.
CountSectors find_edge_sectors(CountReceiver p_receiver, CountedEdge p_first, CountedEdge p_second) {
	const vec3 a0 = count_offset(p_receiver, p_first.a);
	const vec3 b0 = count_offset(p_receiver, p_first.b);
	const vec3 a1 = count_offset(p_receiver, p_second.a);
	const vec3 b1 = count_offset(p_receiver, p_second.b);
	const ivec2 weights = ivec2(p_first.weight, p_second.weight);
	const bvec2 are_left = bvec2(is_count_left(a0.xy, b0.xy), is_count_left(a1.xy, b1.xy));
	// Cut off what is not nearer to the light than the receiver, and what is behind the light.
	const float minimum = p_receiver.min_d;
	const float maximum = MAX_D;
	const bvec2 are_valid = bvec2(weights.x != 0 && max(a0.z, b0.z) > minimum && min(a0.z, b0.z) < maximum,
			weights.y != 0 && max(a1.z, b1.z) > minimum && min(a1.z, b1.z) < maximum);
	vec2 a_x = vec2(a0.x, a1.x);
	vec2 a_y = vec2(a0.y, a1.y);
	vec2 a_d = vec2(a0.z, a1.z);
	vec2 b_x = vec2(b0.x, b1.x);
	vec2 b_y = vec2(b0.y, b1.y);
	vec2 b_d = vec2(b0.z, b1.z);
	const vec2 inverse_length = 1.0 / (b_d - a_d);
	cut_count_offsets(vec2(b0.x, b1.x), vec2(b0.y, b1.y), inverse_length, minimum, maximum, a_x, a_y, a_d);
	cut_count_offsets(vec2(a0.x, a1.x), vec2(a0.y, a1.y), -inverse_length, minimum, maximum, b_x, b_y, b_d);
	// The ends on the disc, X / (d R), with one division for both.
	const vec2 inverse = p_receiver.inverse_radius / (a_d * b_d);
	const vec2 scale_a = b_d * inverse;
	const vec2 scale_b = a_d * inverse;
	const DiscEdges edges = DiscEdges(a_x * scale_a, a_y * scale_a, b_x * scale_b, b_y * scale_b);
	const bvec2 are_reversed = lessThan(weights, ivec2(0));
	return make_count_sectors(DiscEdges(mix(edges.a_x, edges.b_x, are_reversed), mix(edges.a_y, edges.b_y, are_reversed),
									  mix(edges.b_x, edges.a_x, are_reversed), mix(edges.b_y, edges.a_y, are_reversed)),
			notEqual(are_reversed, are_left), abs(weights), are_valid);
}

/// The line along which a face crosses the disc's plane: it bounds the face's shadow, as an edge does. All faces
/// of double-sided mesh parts have this line. Of closed mesh parts, only the faces that count as solids do: those with
/// the receiver in front if p_uses_front_faces, else those with the receiver behind.
CountSectors find_cut_sectors(
		CountReceiver p_receiver, CountFaceRecord p_face, vec4 p_plane, bool p_uses_front_faces) {
	const vec3 a = count_offset(p_receiver, uintBitsToFloat(p_face.a_kind.xyz));
	const vec3 b = count_offset(p_receiver, uintBitsToFloat(p_face.b_first_distance.xyz));
	const vec3 c = count_offset(p_receiver, uintBitsToFloat(p_face.c_end_distance.xyz));
	const bvec3 is_in = lessThan(vec3(a.z, b.z, c.z), vec3(MAX_D));
	const bool is_in_front = is_count_in_front(p_plane, p_receiver.position);
	const bool is_counted = p_face.a_kind.w != 0u || is_in_front == p_uses_front_faces;
	// The sides on which the outline, in winding order, leaves the space in front of the disc, and enters it. Each is
	// cut as in find_edge_sectors, bit for bit.
	const bool leaves_a = is_in.x && !is_in.y;
	const bool leaves_b = is_in.y && !is_in.z;
	const bool enters_a = !is_in.x && is_in.y;
	const bool enters_b = !is_in.y && is_in.z;
	const vec3 leave = leaves_a ? b : (leaves_b ? c : a);
	const vec3 before = leaves_a ? a : (leaves_b ? b : c);
	const vec3 enter = enters_a ? a : (enters_b ? b : c);
	const vec3 after = enters_a ? b : (enters_b ? c : a);
	vec2 x = vec2(leave.x, enter.x);
	vec2 y = vec2(leave.y, enter.y);
	vec2 d = vec2(leave.z, enter.z);
	cut_count_offsets(vec2(before.x, after.x), vec2(before.y, after.y), 1.0 / (vec2(before.z, after.z) - d),
			p_receiver.min_d, MAX_D, x, y, d);
	// This decides on which side of the line the light's centre is, by the same test as count_crossings, so that both
	// agree.
	const bool is_between = is_in_front != is_count_light_in_front(p_plane);
	const vec2 ends_x = (is_in_front ? x : x.yx) * p_receiver.inverse_radius;
	const vec2 ends_y = (is_in_front ? y : y.yx) * p_receiver.inverse_radius;
	const bool is_valid =
			is_counted && any(is_in) && !all(is_in) && is_in_distance_range(p_receiver.leaf_distance, p_face);
	// The second of the two edges is unused.
	const DiscEdges edges = DiscEdges(ends_x.xx, ends_y.xx, ends_x.yy, ends_y.yy);
	return make_count_sectors(edges, bvec2(is_between), ivec2(1), bvec2(is_valid, false));
}

/// Signed weight of an edge as seen by the receiver.
int count_weight(vec3 p_receiver, vec4 p_plane0, vec4 p_plane1, CountEdgeKind p_kind) {
	return count_sum_weights(is_count_in_front(p_plane0, p_receiver),
			p_kind.is_inconsistent != is_count_in_front(p_plane1, p_receiver), p_kind);
}

void add_sample_set(PointCounters p_counters, int p_added, inout CountSums r_sums) {
	const PointCounters sums = add_to_all(p_counters, p_added);
	const uvec2 is_hidden = find_hidden(sums);
	r_sums.hidden += count_points(is_hidden);
	r_sums.count += sum_points(sums);
	add_changes(sums, is_hidden ^ rotate_points(is_hidden), r_sums);
}

/// What to add to the counters of all points.
int find_added(CountState p_state) {
	return clamp(p_state.solid_count, 0, COUNT_MAX_SOLIDS) - p_state.surplus;
}

/// Whether casters overlap at a point of the invocation's sample sets.
bool has_overlap(CountState p_state) {
	const int added = find_added(p_state);
	return has_overlap(add_to_all(p_state.counters0, added)) ||
			(SETS_PER_LANE == 4u &&
					(has_overlap(add_to_all(p_state.counters1, added)) ||
							has_overlap(add_to_all(p_state.counters2, added)) ||
							has_overlap(add_to_all(p_state.counters3, added))));
}

/// The sums over the invocation's sample sets.
CountSums add_sample_sets(CountState p_state) {
	const int added = find_added(p_state);
	CountSums sums = CountSums(0, 0, 0, 0);
	add_sample_set(p_state.counters0, added, sums);
	if (SETS_PER_LANE == 4u) {
		add_sample_set(p_state.counters1, added, sums);
		add_sample_set(p_state.counters2, added, sums);
		add_sample_set(p_state.counters3, added, sums);
	}
	return sums;
}

/// Visibility from all counts, 0..1. If no more than one solid hides the light, the areas alone are
/// exact. Otherwise the hidden points give the visibility, corrected by the mean count, which the areas
/// give more precisely than the points. regression_slope scales this correction: how much of a change of the count
/// changes visibility, by linear regression over pairs of neighbouring points. It is k in "Counting" in
/// doc/techniques/edge_count.md. p_sums: of all sample sets; needed only if p_overlaps.
float find_visibility(CountState p_state, bool p_overlaps, CountSums p_sums) {
	const float fraction = 1.0 / float(uint(EDGE_COUNT_SAMPLE_COUNT) * SAMPLE_SET_COUNT);
	const int solids = clamp(p_state.solid_count, 0, COUNT_MAX_SOLIDS);
	const float mean = float(solids) + float(p_state.area) * AREA_UNIT;
	const float regression_slope = float(p_sums.product) / float(max(p_sums.square, 1));
	const float by_points =
			1.0 - float(p_sums.hidden) * fraction - regression_slope * (mean - float(p_sums.count) * fraction);
	return clamp(p_overlaps ? by_points : 1.0 - mean, 0.0, 1.0);
}

#endif
