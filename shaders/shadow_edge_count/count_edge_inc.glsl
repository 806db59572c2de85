// What one edge adds to a receiver: the two parts of compute_count_visibility in float32.
#ifndef COUNT_EDGE_INC_GLSL
#define COUNT_EDGE_INC_GLSL

#include "shadow_edge_count/count_classify_inc.glsl"
#include "shadow_edge_count/count_layers_inc.glsl"
#include "shadow_edge_count/count_masks_inc.glsl"

const float COUNT_NEARER_TOLERANCE = 2e-5; // as COUNT_AWAY_TOLERANCE
const float COUNT_PI = 3.14159265358979;

/// What was found so far.
struct CountState {
	CountReference reference;
	float area; // signed area of the disc behind edges, metres^2
	CountPlanes planes;
};

CountState make_count_state(CountReference p_reference) {
	CountState state;
	state.reference = p_reference;
	state.area = 0.0;
	state.planes = make_count_planes();
	return state;
}

/// Corrects the count at the reference where the edge's outline, as the light's centre sees it, lies
/// between reference and receiver. p_a, p_b: its ends, p_side = cross(p_a, p_b), from the receiver.
void count_correct_reference(CountViewConstants p_view, CountReceiver p_receiver,
		CountEdgeRecord p_edge, vec2 p_a, vec2 p_b, float p_side, inout CountReference r_reference) {
	const vec2 offset = r_reference.offset;
	const float reference_side = count_cross(p_a - offset, p_b - offset);
	const float at_a = count_cross(offset, p_a);
	const float at_b = count_cross(offset, p_b);
	if ((reference_side > 0.0) == (p_side > 0.0) || (at_a > 0.0) == (at_b > 0.0)) {
		return;
	}
	const float edge_w = mix(p_edge.a_bx.z, p_edge.by_bw_d0_d1.y, at_a / (at_a - at_b));
	const float plane_w = mix(r_reference.w, p_receiver.warped.z,
			reference_side / (reference_side - p_side));
	if (edge_w - plane_w > COUNT_AWAY_TOLERANCE * count_depth_scale(p_view, plane_w)) {
		const int weight = int(p_edge.normal0_weight.w);
		r_reference.solid_count += abs(weight) * ((p_side > 0.0) == (weight < 0) ? 1 : -1);
	}
}

/// Signed weight of the edge as the receiver sees it; see CountEdge.
int count_weight(CountReceiver p_receiver, CountEdgeRecord p_edge) {
	const int kind = int(p_edge.normal1_kind.w);
	const bool is_facing0 =
			dot(p_edge.normal0_weight.xyz, p_receiver.r) + p_edge.by_bw_d0_d1.z > 0.0;
	const bool is_facing1 =
			dot(p_edge.normal1_kind.xyz, p_receiver.r) + p_edge.by_bw_d0_d1.w > 0.0;
	return count_sum_weights(is_facing0, is_facing1, kind);
}

/// Adds the part of the disc beyond an edge from p_a to p_b on the disc's plane, as seen from the
/// disc's centre: a sector without its triangle, and the points of the light in it.
void count_add_sector(
		float p_radius, vec2 p_a, vec2 p_b, float p_side, int p_weight, inout CountState r_state) {
	const vec2 way = p_b - p_a;
	const float square = dot(way, way);
	const vec2 u = way * inversesqrt(max(square, 1e-37));
	const float distance = max(abs(count_cross(p_a, u)), 1e-20);
	if (square < 1e-16 * p_radius * p_radius || distance >= p_radius) {
		return;
	}
	const float half_chord = sqrt(p_radius * p_radius - distance * distance);
	const float from = max(dot(p_a, u), -half_chord);
	const float to = min(dot(p_b, u), half_chord);
	if (to <= from) {
		return;
	}
	const bool is_left = p_side > 0.0;
	const float length_along = to - from;
	// The sector's angle in one arc tangent; from the foot of the centre on the edge, so that no
	// difference of large numbers loses its digits.
	const float angle = atan(distance * length_along, distance * distance + from * to);
	const float part = 0.5 * (p_radius * p_radius * angle - distance * length_along);
	r_state.area += float(is_left ? -p_weight : p_weight) * part;
	const float turn = is_left ? 1.0 : -1.0;
	const vec2 beyond = turn * vec2(u.y, -u.x);
	const vec2 first = turn * vec2(-p_a.y, p_a.x);
	const vec2 before_second = turn * vec2(-p_b.y, p_b.x);
	// Not the points after the second end but those that are not before it: neighbours that share
	// an end leave no crack.
	const uvec2 mask = find_count_mask(beyond, distance / p_radius) & find_count_mask(first, 0.0) &
			~find_count_mask(before_second, 0.0);
	for (int i = 0; i < p_weight; ++i) {
		count_step(r_state.planes, mask, !is_left);
	}
}

/// All that one edge adds.
void count_add_edge(CountViewConstants p_view, CountReceiver p_receiver, CountEdgeRecord p_edge,
		inout CountState r_state) {
	const vec3 a = p_edge.a_bx.xyz - p_receiver.warped;
	const vec3 b = vec3(p_edge.a_bx.w, p_edge.by_bw_d0_d1.xy) - p_receiver.warped;
	float side = count_cross(a.xy, b.xy); // the one value that both parts use
	if (p_edge.normal0_weight.w != 0.0) {
		count_correct_reference(
				p_view, p_receiver, p_edge, a.xy, b.xy, side, r_state.reference);
	}
	const int weight = count_weight(p_receiver, p_edge);
	const float least = COUNT_NEARER_TOLERANCE * p_receiver.scale;
	vec3 from = count_project(p_receiver, a);
	vec3 to = count_project(p_receiver, b);
	if (weight == 0 || side == 0.0 || (from.z <= least && to.z <= least)) {
		return;
	}
	if (from.z <= least) {
		from = vec3(mix(from.xy, to.xy, (least - from.z) / (to.z - from.z)), least);
	} else if (to.z <= least) {
		to = vec3(mix(to.xy, from.xy, (least - to.z) / (from.z - to.z)), least);
	}
	const vec2 first = from.xy / from.z;
	const vec2 second = to.xy / to.z;
	if (weight < 0) {
		count_add_sector(p_view.disc_radius, second, first, -side, -weight, r_state);
	} else {
		count_add_sector(p_view.disc_radius, first, second, side, weight, r_state);
	}
}

/// Visibility from all that was counted, 0..1.
float count_resolve(CountViewConstants p_view, CountState p_state) {
	const int SATURATION = 15;
	const float SMALLEST_RADIUS = 1e-6;
	const int solids = clamp(p_state.reference.solid_count, 0, SATURATION);
	const float least = SMALLEST_RADIUS * (p_view.is_directional != 0u ? 1.0 : p_view.scene_size_m);
	const float radius = max(p_view.disc_radius, least);
	const float mean = float(solids) + p_state.area / (COUNT_PI * radius * radius);
	int over = 0;
	int under = 0;
	int blocked = 0;
	for (uint i = 0u; i < uint(EDGE_COUNT_SAMPLE_COUNT); ++i) {
		const int count = solids + get_count(p_state.planes, i);
		blocked += count >= 1 ? 1 : 0;
		over += max(count - 1, 0);
		under += max(-count, 0);
	}
	if (over + under == 0) {
		return 1.0 - clamp(mean, 0.0, 1.0); // one layer at most: exact
	}
	const float share = 1.0 / float(EDGE_COUNT_SAMPLE_COUNT);
	const float exact = 1.0 - clamp(mean - float(over - under) * share, 0.0, 1.0);
	return mix(1.0 - float(blocked) * share, exact,
			clamp(1.0 - float(over + under) * share, 0.0, 1.0));
}

#endif
