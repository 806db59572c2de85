// The contribution of one edge to a receiver, and the resulting visibility:
// compute_count_visibility in float32.
#ifndef COUNT_EDGE_INC_GLSL
#define COUNT_EDGE_INC_GLSL

#include "shadow_edge_count/count_classify_inc.glsl"
#include "shadow_edge_count/count_masks_inc.glsl"

/// The counts so far.
struct CountState {
	int solid_count; // between the receiver and the light's centre
	float area;		 // twice the signed area of the disc behind edges, in R^2
	int surplus;	 // of all counters: what is subtracted at some points is added at the others instead
	CountPlanes turn0;
#if COUNT_TURN_COUNT == 4
	CountPlanes turn1;
	CountPlanes turn2;
	CountPlanes turn3;
#endif
};

CountState make_count_state(int p_solid_count) {
	CountState state;
	state.solid_count = p_solid_count;
	state.area = 0.0;
	state.surplus = 0;
	state.turn0 = make_count_planes();
#if COUNT_TURN_COUNT == 4
	state.turn1 = state.turn0;
	state.turn2 = state.turn0;
	state.turn3 = state.turn0;
#endif
	return state;
}

/// A region of the disc: beyond a line, from one direction counter-clockwise to another.
struct CountSector {
	float area;		  // twice, signed, in R^2
	uint mask_index;  // of the points beyond the line
	float from_angle; // see find_count_angle
	float to_angle;
	// Its points are subtracted by adding the others; once or twice, or nothing is added.
	uint flip;
	uint once;
	uint twice;
};

CountSector make_no_sector() {
	return CountSector(0.0, 0u, 0.0, 0.0, 0u, 0u, 0u);
}

/// All bits or none.
uint find_bits(bool p_is_set) {
	return p_is_set ? 0xffffffffu : 0u;
}

/// The part of the disc beyond an edge from p_a to p_b on the disc's plane, as seen from the disc's centre: a sector
/// without its triangle. In units of R. Without a branch: software drivers run both sides.
CountSector make_count_sector(vec2 p_a, vec2 p_b, bool p_is_left, int p_weight, bool p_is_there) {
	const vec2 way = p_b - p_a;
	const float square = dot(way, way);
	const vec2 u = way * inversesqrt(max(square, 1e-37));
	const float distance = max(abs(count_cross(p_a, u)), 1e-20);
	const float half_chord = sqrt(max(1.0 - distance * distance, 0.0));
	const float from = max(dot(p_a, u), -half_chord);
	const float to = min(dot(p_b, u), half_chord);
	const float length_along = to - from;
	// The sector's angle in one arc tangent; from the foot of the centre on the edge, so that no
	// difference of large numbers loses its digits.
	const float angle =
			count_half_angle(vec2(distance * distance + from * to, distance * length_along));
	const float part = angle - distance * length_along;
	CountSector sector;
	const bool is_there = p_is_there && square >= 1e-16 && distance < 1.0 && length_along > 0.0;
	sector.area = is_there ? float(p_is_left ? -p_weight : p_weight) * part : 0.0;
	sector.mask_index = find_count_mask_index(p_is_left ? vec2(u.y, -u.x) : vec2(-u.y, u.x), distance);
	sector.from_angle = find_count_angle(p_is_left ? p_a : p_b);
	sector.to_angle = find_count_angle(p_is_left ? p_b : p_a);
	sector.flip = find_bits(p_is_left);
	sector.once = find_bits(is_there && p_weight != 2);
	sector.twice = find_bits(is_there && p_weight == 2);
	return sector;
}

/// The points of one turn at which a sector adds.
uvec2 find_sector_points(CountSector p_sector, uvec2 p_mask, uint p_turn) {
	return (p_mask & find_count_wedge(p_sector.from_angle, p_sector.to_angle, p_turn)) ^ p_sector.flip;
}

void count_turn(CountSector p_first, CountSector p_second, uvec2 p_first_mask, uvec2 p_second_mask, uint p_turn,
		inout CountPlanes r_planes) {
	const uvec2 first = find_sector_points(p_first, p_first_mask, p_turn);
	const uvec2 second = find_sector_points(p_second, p_second_mask, p_turn);
	add_masks(r_planes, first & p_first.once, second & p_second.once, first & p_first.twice, second & p_second.twice);
}

/// What a sector adds to all counters too much.
int find_surplus(CountSector p_sector) {
	return int((p_sector.flip & p_sector.once & 1u) + (p_sector.flip & p_sector.twice & 2u));
}

/// Adds two sectors' areas and points: two at a time need half as many carries. Without a branch: where the sides of one
/// meet, software drivers copy all counters.
void count_sectors(CountSector p_first, CountSector p_second, inout CountState r_state) {
	r_state.area += p_first.area;
	r_state.area += p_second.area;
	r_state.surplus += find_surplus(p_first) + find_surplus(p_second);
	const uvec4 first0 = load_count_masks(p_first.mask_index, 0u);
	const uvec4 second0 = load_count_masks(p_second.mask_index, 0u);
	count_turn(p_first, p_second, first0.xy, second0.xy, 0u, r_state.turn0);
#if COUNT_TURN_COUNT == 4
	const uvec4 first1 = load_count_masks(p_first.mask_index, 1u);
	const uvec4 second1 = load_count_masks(p_second.mask_index, 1u);
	count_turn(p_first, p_second, first0.zw, second0.zw, 1u, r_state.turn1);
	count_turn(p_first, p_second, first1.xy, second1.xy, 2u, r_state.turn2);
	count_turn(p_first, p_second, first1.zw, second1.zw, 3u, r_state.turn3);
#endif
}

/// Moves one end of a segment of offsets along it until d is in a range, which has some of the segment's.
vec3 cut_count_offset(vec3 p_end, vec3 p_other, float p_least, float p_most) {
	const float d = clamp(p_end.z, p_least, p_most);
	const float share = (d - p_end.z) / (p_other.z - p_end.z);
	return d == p_end.z ? p_end : vec3(mix(p_end.xy, p_other.xy, share), d);
}

/// The part of the light beyond an edge. p_weight: as the receiver sees it; 0: nothing.
CountSector find_edge_sector(CountReceiver p_receiver, vec3 p_a, vec3 p_b, int p_weight) {
	const vec3 from = count_offset(p_receiver, p_a);
	const vec3 to = count_offset(p_receiver, p_b);
	const bool is_left = is_count_left(from.xy, to.xy);
	// Cut where it is no nearer to the light than the receiver, and where it is behind the light.
	const float least = p_receiver.least_d;
	const float most = p_receiver.most_d;
	const bool is_there = p_weight != 0 && max(from.z, to.z) > least && min(from.z, to.z) < most;
	const vec3 first = cut_count_offset(from, to, least, most);
	const vec3 second = cut_count_offset(to, from, least, most);
	const float inverse = p_receiver.inverse_radius / (first.z * second.z);
	const vec2 x_first = first.xy * (second.z * inverse);
	const vec2 x_second = second.xy * (first.z * inverse);
	const bool is_reversed = p_weight < 0;
	return make_count_sector(is_reversed ? x_second : x_first, is_reversed ? x_first : x_second,
			is_reversed != is_left, abs(p_weight), is_there);
}

/// Adds the line along which a face passes through the disc's plane: there ends what hides the light, as at an edge.
/// Of closed parts only the faces before the receiver, or those behind which it is, end what is counted.
void count_add_cut(CountReceiver p_receiver, CountFaceRecord p_face, vec4 p_plane, bool p_has_before,
		inout CountState r_state) {
	const vec3 a = count_offset(p_receiver, uintBitsToFloat(p_face.a_kind.xyz));
	const vec3 b = count_offset(p_receiver, uintBitsToFloat(p_face.b.xyz));
	const vec3 c = count_offset(p_receiver, uintBitsToFloat(p_face.c.xyz));
	const float least = p_receiver.least_d;
	const float most = p_receiver.most_d;
	const bvec3 is_in = lessThan(vec3(a.z, b.z, c.z), vec3(most));
	const bool is_before = is_count_before(p_plane, p_receiver.position);
	const bool is_counted = p_face.a_kind.w != 0u || is_before == p_has_before;
	// The sides on which its outline, as it winds, leaves the space before the disc, and enters it; each is cut as
	// find_edge_sector does it, bit for bit.
	const bool leaves_a = is_in.x && !is_in.y;
	const bool leaves_b = is_in.y && !is_in.z;
	const bool enters_a = !is_in.x && is_in.y;
	const bool enters_b = !is_in.y && is_in.z;
	const vec3 leave = cut_count_offset(leaves_a ? b : (leaves_b ? c : a), leaves_a ? a : (leaves_b ? b : c), least, most);
	const vec3 enter = cut_count_offset(enters_a ? a : (enters_b ? b : c), enters_a ? b : (enters_b ? c : a), least, most);
	// Which side of the line the light's centre is on: as count_node has it, so that both agree.
	const bool is_between = is_before != is_count_light_before(false, p_plane);
	const vec2 from = (is_before ? leave.xy : enter.xy) * p_receiver.inverse_radius;
	const vec2 to = (is_before ? enter.xy : leave.xy) * p_receiver.inverse_radius;
	const CountSector sector = make_count_sector(from, to, is_between, 1, is_counted && any(is_in) && !all(is_in));
	count_sectors(sector, make_no_sector(), r_state);
}

/// Signed weight of an edge as the receiver sees it.
int count_weight(vec3 p_receiver, vec4 p_plane0, vec4 p_plane1, CountEdgeKind p_kind) {
	return count_sum_weights(is_count_before(p_plane0, p_receiver),
			p_kind.is_inconsistent != is_count_before(p_plane1, p_receiver), p_kind);
}

/// Sums over the points of the light.
struct CountSums {
	int hidden; // points whose count is above 0
	int count;	// of all counts
	CountChanges changes;
};

void add_turn(CountPlanes p_planes, int p_added, inout CountSums r_sums) {
	const CountPlanes sums = add_to_all(p_planes, p_added);
	const uvec2 is_hidden = find_hidden(sums);
	r_sums.hidden += count_points(is_hidden);
	r_sums.count += sum_points(sums);
	const CountChanges changes = sum_changes(sums, is_hidden ^ turn_points(is_hidden));
	r_sums.changes.square += changes.square;
	r_sums.changes.product += changes.product;
}

bool has_overlap(CountState p_state, int p_added) {
	bool overlaps = has_overlap(add_to_all(p_state.turn0, p_added));
#if COUNT_TURN_COUNT == 4
	overlaps = overlaps || has_overlap(add_to_all(p_state.turn1, p_added)) ||
			has_overlap(add_to_all(p_state.turn2, p_added)) || has_overlap(add_to_all(p_state.turn3, p_added));
#endif
	return overlaps;
}

/// Visibility from all that was counted, 0..1. Where no more than one solid hides the light, the areas alone
/// are exact. Else the share of hidden points is corrected by what the areas know better than the points, the
/// mean of the counts; as much of it as neighbouring points show, by least squares, that a change of the count is a
/// change between hidden and visible.
float count_resolve(CountState p_state) {
	const float share = 1.0 / float(EDGE_COUNT_SAMPLE_COUNT * COUNT_TURN_COUNT);
	const int solids = clamp(p_state.solid_count, 0, COUNT_MOST_SOLIDS);
	const float mean = float(solids) + p_state.area / (2.0 * COUNT_PI);
	float visibility = 1.0 - mean;
	const int added = solids - p_state.surplus;
	if (has_overlap(p_state, added)) {
		CountSums sums = CountSums(0, 0, CountChanges(0, 0));
		add_turn(p_state.turn0, added, sums);
#if COUNT_TURN_COUNT == 4
		add_turn(p_state.turn1, added, sums);
		add_turn(p_state.turn2, added, sums);
		add_turn(p_state.turn3, added, sums);
#endif
		const float trust = float(sums.changes.product) / float(max(sums.changes.square, 1));
		visibility = 1.0 - float(sums.hidden) * share - trust * (mean - float(sums.count) * share);
	}
	return clamp(visibility, 0.0, 1.0);
}

#endif
