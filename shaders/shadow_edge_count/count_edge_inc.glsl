// The contribution of one edge to a receiver's counts, and the resulting visibility: the float32
// version of compute_count_visibility in tests/count_in_double.h.
#ifndef COUNT_EDGE_INC_GLSL
#define COUNT_EDGE_INC_GLSL

#include "shadow_edge_count/count_classify_inc.glsl"
#include "shadow_edge_count/count_masks_inc.glsl"

/// The counts of a receiver so far.
struct CountState {
	int solid_count; // between the receiver and the light's centre
	float area;		 // twice the signed area of the disc behind edges, in R^2
	int surplus;	 // to subtract from all counters: subtracting at some points is done by adding at all others
	PointCounters counters0;
#if COUNT_SAMPLE_SET_COUNT == 4
	PointCounters counters1;
	PointCounters counters2;
	PointCounters counters3;
#endif
};

CountState make_count_state(int p_solid_count) {
	CountState state;
	state.solid_count = p_solid_count;
	state.area = 0.0;
	state.surplus = 0;
	state.counters0 = make_point_counters();
#if COUNT_SAMPLE_SET_COUNT == 4
	state.counters1 = state.counters0;
	state.counters2 = state.counters0;
	state.counters3 = state.counters0;
#endif
	return state;
}

/// A region of the light's disc: beyond a line, and between two directions counter-clockwise.
struct CountSector {
	float area;		  // twice the signed area, in R^2
	uint mask_index;  // of the points beyond the line, see find_count_mask_index
	float from_angle; // see find_count_angle
	float to_angle;
	// All bits are set, or none. flip: subtract, by adding at all other points. once, twice: how much to add.
	uint flip;
	uint once;
	uint twice;
};

CountSector make_empty_sector() {
	return CountSector(0.0, 0u, 0.0, 0.0, 0u, 0u, 0u);
}

/// All bits set, or none.
uint make_bit_mask(bool p_is_set) {
	return p_is_set ? 0xffffffffu : 0u;
}

/// The region of the disc beyond an edge from p_a to p_b in the disc's plane, seen from the disc's centre: a circular
/// sector without its triangle. Units of R. p_is_left: see is_count_left. p_weight: 0, 1 or 2. Empty unless p_is_valid.
/// Without branches, since software drivers execute both sides.
CountSector make_count_sector(vec2 p_a, vec2 p_b, bool p_is_left, int p_weight, bool p_is_valid) {
	const vec2 edge_direction = p_b - p_a;
	const float square = dot(edge_direction, edge_direction);
	const vec2 u = edge_direction * inversesqrt(max(square, 1e-37));
	const float distance = max(abs(count_cross(p_a, u)), 1e-20);
	const float half_chord = sqrt(max(1.0 - distance * distance, 0.0));
	const float from = max(dot(p_a, u), -half_chord);
	const float to = min(dot(p_b, u), half_chord);
	const float length_along = to - from;
	// The sector's angle, from one arc tangent. from and to are measured from the foot of the
	// perpendicular from the centre, which avoids cancellation.
	const float angle =
			count_half_angle(vec2(distance * distance + from * to, distance * length_along));
	const float twice_area = angle - distance * length_along;
	CountSector sector;
	const bool is_valid = p_is_valid && square >= 1e-16 && distance < 1.0 && length_along > 0.0;
	sector.area = is_valid ? float(p_is_left ? -p_weight : p_weight) * twice_area : 0.0;
	sector.mask_index = find_count_mask_index(p_is_left ? vec2(u.y, -u.x) : vec2(-u.y, u.x), distance);
	sector.from_angle = find_count_angle(p_is_left ? p_a : p_b);
	sector.to_angle = find_count_angle(p_is_left ? p_b : p_a);
	sector.flip = make_bit_mask(p_is_left);
	sector.once = make_bit_mask(is_valid && p_weight != 2);
	sector.twice = make_bit_mask(is_valid && p_weight == 2);
	return sector;
}

/// The points of one sample set at which a sector adds.
uvec2 find_sector_points(CountSector p_sector, uvec2 p_mask, uint p_sample_set) {
	return (p_mask & find_count_wedge(p_sector.from_angle, p_sector.to_angle, p_sample_set)) ^ p_sector.flip;
}

void count_sample_set(CountSector p_first, CountSector p_second, uvec2 p_first_mask,
		uvec2 p_second_mask, uint p_sample_set, inout PointCounters r_counters) {
	const uvec2 first = find_sector_points(p_first, p_first_mask, p_sample_set);
	const uvec2 second = find_sector_points(p_second, p_second_mask, p_sample_set);
	add_masks(r_counters, first & p_first.once, second & p_second.once, first & p_first.twice, second & p_second.twice);
}

/// What a flipped sector adds to all counters in excess.
int find_surplus(CountSector p_sector) {
	return int((p_sector.flip & p_sector.once & 1u) + (p_sector.flip & p_sector.twice & 2u));
}

/// Adds the areas and points of two sectors: two at a time need half as many carries. Without branches, since software
/// drivers copy all counters where the sides of a branch join.
void count_sectors(CountSector p_first, CountSector p_second, inout CountState r_state) {
	r_state.area += p_first.area;
	r_state.area += p_second.area;
	r_state.surplus += find_surplus(p_first) + find_surplus(p_second);
	const uvec4 first0 = load_count_masks(p_first.mask_index, 0u);
	const uvec4 second0 = load_count_masks(p_second.mask_index, 0u);
	count_sample_set(p_first, p_second, first0.xy, second0.xy, 0u, r_state.counters0);
#if COUNT_SAMPLE_SET_COUNT == 4
	const uvec4 first1 = load_count_masks(p_first.mask_index, 1u);
	const uvec4 second1 = load_count_masks(p_second.mask_index, 1u);
	count_sample_set(p_first, p_second, first0.zw, second0.zw, 1u, r_state.counters1);
	count_sample_set(p_first, p_second, first1.xy, second1.xy, 2u, r_state.counters2);
	count_sample_set(p_first, p_second, first1.zw, second1.zw, 3u, r_state.counters3);
#endif
}

/// Moves the end p_end of a segment of (X, d) along it until d is in p_min..p_max. Some d of the segment must be.
vec3 cut_count_offset(vec3 p_end, vec3 p_other, float p_min, float p_max) {
	const float d = clamp(p_end.z, p_min, p_max);
	const float fraction = (d - p_end.z) / (p_other.z - p_end.z);
	return d == p_end.z ? p_end : vec3(mix(p_end.xy, p_other.xy, fraction), d);
}

/// The region of the light beyond an edge. p_weight: the edge's weight as seen by the receiver; if 0, it is empty.
CountSector find_edge_sector(CountReceiver p_receiver, vec3 p_a, vec3 p_b, int p_weight) {
	const vec3 from = count_offset(p_receiver, p_a);
	const vec3 to = count_offset(p_receiver, p_b);
	const bool is_left = is_count_left(from.xy, to.xy);
	// Cut off what is not nearer to the light than the receiver, and what is behind the light.
	const float minimum = p_receiver.min_d;
	const float maximum = p_receiver.max_d;
	const bool is_valid = p_weight != 0 && max(from.z, to.z) > minimum && min(from.z, to.z) < maximum;
	const vec3 first = cut_count_offset(from, to, minimum, maximum);
	const vec3 second = cut_count_offset(to, from, minimum, maximum);
	const float inverse = p_receiver.inverse_radius / (first.z * second.z);
	const vec2 x_first = first.xy * (second.z * inverse);
	const vec2 x_second = second.xy * (first.z * inverse);
	const bool is_reversed = p_weight < 0;
	return make_count_sector(is_reversed ? x_second : x_first, is_reversed ? x_first : x_second,
			is_reversed != is_left, abs(p_weight), is_valid);
}

/// Adds the line along which a face crosses the disc's plane: it bounds the face's shadow, as an edge does. All faces
/// of double-sided mesh parts have this line. Of closed mesh parts, only the faces that count as solids do: those with
/// the receiver in front if p_uses_front_faces, else those with the receiver behind.
void count_add_cut(CountReceiver p_receiver, CountFaceRecord p_face, vec4 p_plane, bool p_uses_front_faces,
		inout CountState r_state) {
	const vec3 a = count_offset(p_receiver, uintBitsToFloat(p_face.a_kind.xyz));
	const vec3 b = count_offset(p_receiver, uintBitsToFloat(p_face.b_first_distance.xyz));
	const vec3 c = count_offset(p_receiver, uintBitsToFloat(p_face.c_end_distance.xyz));
	const float minimum = p_receiver.min_d;
	const float maximum = p_receiver.max_d;
	const bvec3 is_in = lessThan(vec3(a.z, b.z, c.z), vec3(maximum));
	const bool is_in_front = is_count_in_front(p_plane, p_receiver.position);
	const bool is_counted = p_face.a_kind.w != 0u || is_in_front == p_uses_front_faces;
	// The sides on which the outline, in winding order, leaves the space in front of the disc, and enters it. Each is
	// cut as in find_edge_sector, bit for bit.
	const bool leaves_a = is_in.x && !is_in.y;
	const bool leaves_b = is_in.y && !is_in.z;
	const bool enters_a = !is_in.x && is_in.y;
	const bool enters_b = !is_in.y && is_in.z;
	const vec3 leave = cut_count_offset(
			leaves_a ? b : (leaves_b ? c : a), leaves_a ? a : (leaves_b ? b : c), minimum, maximum);
	const vec3 enter = cut_count_offset(
			enters_a ? a : (enters_b ? b : c), enters_a ? b : (enters_b ? c : a), minimum, maximum);
	// This decides on which side of the line the light's centre is, by the same test as count_node, so that both agree.
	const bool is_between = is_in_front != is_count_light_in_front(false, p_plane);
	const vec2 from = (is_in_front ? leave.xy : enter.xy) * p_receiver.inverse_radius;
	const vec2 to = (is_in_front ? enter.xy : leave.xy) * p_receiver.inverse_radius;
	const CountSector sector = make_count_sector(from, to, is_between, 1,
			is_counted && any(is_in) && !all(is_in) && is_count_level(p_receiver.part_distance, p_face));
	count_sectors(sector, make_empty_sector(), r_state);
}

/// Signed weight of an edge as seen by the receiver.
int count_weight(vec3 p_receiver, vec4 p_plane0, vec4 p_plane1, CountEdgeKind p_kind) {
	return count_sum_weights(is_count_in_front(p_plane0, p_receiver),
			p_kind.is_inconsistent != is_count_in_front(p_plane1, p_receiver), p_kind);
}

/// Sums over the points of the light.
struct CountSums {
	int hidden; // points whose count is above 0
	int count;	// sum of all counts
	CountChanges changes;
};

void add_sample_set(PointCounters p_counters, int p_added, inout CountSums r_sums) {
	const PointCounters sums = add_to_all(p_counters, p_added);
	const uvec2 is_hidden = find_hidden(sums);
	r_sums.hidden += count_points(is_hidden);
	r_sums.count += sum_points(sums);
	const CountChanges changes = sum_changes(sums, is_hidden ^ rotate_points(is_hidden));
	r_sums.changes.square += changes.square;
	r_sums.changes.product += changes.product;
}

bool has_overlap(CountState p_state, int p_added) {
	bool overlaps = has_overlap(add_to_all(p_state.counters0, p_added));
#if COUNT_SAMPLE_SET_COUNT == 4
	overlaps = overlaps || has_overlap(add_to_all(p_state.counters1, p_added)) ||
			has_overlap(add_to_all(p_state.counters2, p_added)) || has_overlap(add_to_all(p_state.counters3, p_added));
#endif
	return overlaps;
}

/// Visibility from all counts, 0..1. If no more than one solid hides the light, the areas alone are
/// exact. Otherwise the hidden points give the visibility, corrected by the mean count, which the areas
/// give more precisely than the points. beta scales this correction: how much of a change of the count
/// changes visibility, by linear regression over pairs of neighbouring points. It is k in "Counting" in
/// doc/techniques/edge_count.md.
float count_resolve(CountState p_state) {
	const float fraction = 1.0 / float(EDGE_COUNT_SAMPLE_COUNT * COUNT_SAMPLE_SET_COUNT);
	const int solids = clamp(p_state.solid_count, 0, COUNT_MAX_SOLIDS);
	const float mean = float(solids) + p_state.area / (2.0 * COUNT_PI);
	float visibility = 1.0 - mean;
	const int added = solids - p_state.surplus;
	if (has_overlap(p_state, added)) {
		CountSums sums = CountSums(0, 0, CountChanges(0, 0));
		add_sample_set(p_state.counters0, added, sums);
#if COUNT_SAMPLE_SET_COUNT == 4
		add_sample_set(p_state.counters1, added, sums);
		add_sample_set(p_state.counters2, added, sums);
		add_sample_set(p_state.counters3, added, sums);
#endif
		const float regression_slope = float(sums.changes.product) / float(max(sums.changes.square, 1));
		visibility = 1.0 - float(sums.hidden) * fraction - regression_slope * (mean - float(sums.count) * fraction);
	}
	return clamp(visibility, 0.0, 1.0);
}

#endif
