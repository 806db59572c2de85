// What one edge adds to a receiver: the two parts of compute_count_visibility in float32.
#ifndef COUNT_EDGE_INC_GLSL
#define COUNT_EDGE_INC_GLSL

#include "shadow_edge_count/count_classify_inc.glsl"
#include "shadow_edge_count/count_cull_inc.glsl"
#include "shadow_edge_count/count_layers_inc.glsl"
#include "shadow_edge_count/count_masks_inc.glsl"

const float COUNT_NEARER_TOLERANCE = 2e-5; // as COUNT_AWAY_TOLERANCE

/// The planes of an edge's faces.
struct CountEdgePlanes {
	vec4 plane0;
	vec4 plane1;
};
/// Of a record; asked for only where receivers that are dealt with together see different sides.
CountEdgePlanes load_count_planes(uint p_record);

/// The rest of a record.
struct CountSegment {
	vec3 a; // (x', y', w)
	vec3 b;
	int center_weight; // as seen from the light's centre
	int kind;
};

CountSegment make_count_segment(vec4 p_a_bx, vec4 p_by_bw_weight_kind) {
	return CountSegment(p_a_bx.xyz, vec3(p_a_bx.w, p_by_bw_weight_kind.xy),
			int(p_by_bw_weight_kind.z), int(p_by_bw_weight_kind.w));
}

/// What was found so far.
struct CountState {
	CountReference reference;
	float area; // twice the signed area of the disc behind edges, in R^2
	CountPlanes planes[COUNT_TURN_COUNT];
};

CountState make_count_state(CountReference p_reference) {
	CountState state;
	state.reference = p_reference;
	state.area = 0.0;
	for (int turn = 0; turn < COUNT_TURN_COUNT; ++turn) {
		state.planes[turn] = make_count_planes();
	}
	return state;
}

/// Corrects the count at the reference where the edge's outline, as the light's centre sees it, lies
/// between reference and receiver. p_a, p_b: its ends, p_side = cross(p_a, p_b), from the receiver.
void count_correct_reference(CountViewConstants p_view, CountReceiver p_receiver,
		CountSegment p_edge, vec2 p_a, vec2 p_b, float p_side, inout CountReference r_reference) {
	const vec2 offset = r_reference.offset;
	const float reference_side = count_cross(p_a - offset, p_b - offset);
	const float at_a = count_cross(offset, p_a);
	const float at_b = count_cross(offset, p_b);
	if ((reference_side > 0.0) == (p_side > 0.0) || (at_a > 0.0) == (at_b > 0.0)) {
		return;
	}
	const float edge_w = mix(p_edge.a.z, p_edge.b.z, at_a / (at_a - at_b));
	const float plane_w = mix(r_reference.w, p_receiver.warped.z,
			reference_side / (reference_side - p_side));
	// A sheet bends up and down: its own rim may lie a little above its receiver's plane.
	const float tolerance = (p_edge.kind & EDGE_COUNT_DOUBLE_SIDED) != 0 ? COUNT_TOWARD_TOLERANCE
																		  : COUNT_AWAY_TOLERANCE;
	if (edge_w - plane_w > tolerance * count_depth_scale(p_view, plane_w)) {
		const int weight = p_edge.center_weight;
		r_reference.solid_count += abs(weight) * ((p_side > 0.0) == (weight < 0) ? 1 : -1);
	}
}

/// Signed weight of the edge as the receiver sees it; see CountEdge.
int count_weight(CountReceiver p_receiver, CountEdgePlanes p_planes, int p_kind) {
	const bool is_facing0 = dot(p_planes.plane0.xyz, p_receiver.r) + p_planes.plane0.w > 0.0;
	const bool is_facing1 = dot(p_planes.plane1.xyz, p_receiver.r) + p_planes.plane1.w > 0.0;
	return count_sum_weights(is_facing0, is_facing1, p_kind);
}

/// Adds the part of the disc beyond an edge from p_a to p_b on the disc's plane, as seen from the
/// disc's centre: a sector without its triangle, and the points of the light in it. In units of R.
void count_add_sector(vec2 p_a, vec2 p_b, float p_side, int p_weight, inout CountState r_state) {
	const vec2 way = p_b - p_a;
	const float square = dot(way, way);
	const vec2 u = way * inversesqrt(max(square, 1e-37));
	const float distance = max(abs(count_cross(p_a, u)), 1e-20);
	const float half_chord = sqrt(max(1.0 - distance * distance, 0.0));
	const float from = max(dot(p_a, u), -half_chord);
	const float to = min(dot(p_b, u), half_chord);
	const float length_along = to - from;
	if (square < 1e-16 || distance >= 1.0 || !(length_along > 0.0)) {
		return;
	}
	const bool is_left = p_side > 0.0;
	// The sector's angle in one arc tangent; from the foot of the centre on the edge, so that no
	// difference of large numbers loses its digits.
	const float angle =
			count_half_angle(vec2(distance * distance + from * to, distance * length_along));
	const float part = angle - distance * length_along;
	r_state.area += float(is_left ? -p_weight : p_weight) * part;
	const vec2 beyond = is_left ? vec2(u.y, -u.x) : vec2(-u.y, u.x);
	for (int turn = 0; turn < COUNT_TURN_COUNT; ++turn) {
		const uvec2 mask = find_count_mask(beyond, distance, turn) &
				find_count_wedge(is_left ? p_a : p_b, is_left ? p_b : p_a, turn);
		count_step(r_state.planes[turn], mask, p_weight == 2, !is_left);
	}
}

/// What the part of the light beyond an edge adds. p_weight: as the receiver sees it.
void count_add_area(
		CountReceiver p_receiver, CountSegment p_edge, int p_weight, inout CountState r_state) {
	const vec3 a = p_edge.a - p_receiver.warped;
	const vec3 b = p_edge.b - p_receiver.warped;
	const float side = count_cross(a.xy, b.xy);
	const float least = COUNT_NEARER_TOLERANCE * p_receiver.scale;
	const vec3 from = count_project(p_receiver, a);
	const vec3 to = count_project(p_receiver, b);
	const float share = (least - from.z) / (to.z - from.z);
	const vec3 cut = vec3(mix(from.xy, to.xy, share), least);
	const bool is_from_cut = from.z <= least;
	const bool is_to_cut = to.z <= least;
	if (p_weight == 0 || side == 0.0 || (is_from_cut && is_to_cut)) {
		return;
	}
	const vec3 first = is_from_cut ? cut : from;
	const vec3 second = is_to_cut ? cut : to;
	const float inverse = p_receiver.inverse_radius / (first.z * second.z);
	const vec2 x_first = first.xy * (second.z * inverse);
	const vec2 x_second = second.xy * (first.z * inverse);
	const bool is_reversed = p_weight < 0;
	count_add_sector(is_reversed ? x_second : x_first, is_reversed ? x_first : x_second,
			is_reversed ? -side : side, abs(p_weight), r_state);
}

/// The weight in what find_count_use gave, where it has COUNT_USE_ONE_WEIGHT.
int count_use_weight(uint p_use) {
	return int(p_use >> COUNT_WEIGHT_SHIFT) - COUNT_WEIGHT_BIAS;
}

/// All that one edge adds. p_record: its place, for its planes; p_use: see find_count_use.
void count_add_edge(CountViewConstants p_view, CountReceiver p_receiver, CountSegment p_edge,
		uint p_record, uint p_use, inout CountState r_state) {
	if ((p_use & COUNT_USE_CENTER) != 0u) {
		const vec2 a = p_edge.a.xy - p_receiver.warped.xy;
		const vec2 b = p_edge.b.xy - p_receiver.warped.xy;
		// The same product as in count_add_area, bit for bit: both tests must agree.
		count_correct_reference(
				p_view, p_receiver, p_edge, a, b, count_cross(a, b), r_state.reference);
	}
	if ((p_use & COUNT_USE_AREA) != 0u) {
		const int weight = (p_use & COUNT_USE_ONE_WEIGHT) != 0u
				? count_use_weight(p_use)
				: count_weight(p_receiver, load_count_planes(p_record), p_edge.kind);
		count_add_area(p_receiver, p_edge, weight, r_state);
	}
}

/// Visibility from all that was counted, 0..1.
float count_resolve(CountState p_state) {
	const int SATURATION = 15;
	const int solids = clamp(p_state.reference.solid_count, 0, SATURATION);
	const float mean = float(solids) + p_state.area / (2.0 * COUNT_PI);
	int over = 0;
	int under = 0;
	int blocked = 0;
	for (int turn = 0; turn < COUNT_TURN_COUNT; ++turn) {
		const CountTotals totals = sum_counts(p_state.planes[turn], solids);
		over += totals.over;
		under += totals.under;
		blocked += totals.blocked;
	}
	if (over + under == 0) {
		return 1.0 - clamp(mean, 0.0, 1.0); // one layer at most: exact
	}
	if (blocked == EDGE_COUNT_SAMPLE_COUNT * COUNT_TURN_COUNT) {
		return 0.0; // what the area of overlaps, known by points alone, would leave is noise
	}
	const float share = 1.0 / float(EDGE_COUNT_SAMPLE_COUNT * COUNT_TURN_COUNT);
	const float exact = 1.0 - clamp(mean - float(over - under) * share, 0.0, 1.0);
	return mix(1.0 - float(blocked) * share, exact,
			clamp(1.0 - float(over + under) * share, 0.0, 1.0));
}

#endif
