// Which edges a receiver may have to count: add_count_edges in float32.
#ifndef COUNT_CLASSIFY_INC_GLSL
#define COUNT_CLASSIFY_INC_GLSL

#include "shadow_edge_count/count_space_inc.glsl"

/// n and d of a face in the view, n unit: n.r + d = 0, above 0 in front. All 0 for a face without
/// area. Made once per face, so that both edges' sides of it are equal bit for bit.
vec4 make_count_plane(vec3 p_a, vec3 p_b, vec3 p_c) {
	// The longest side's direction is exact enough for slivers; its scale must not underflow.
	const vec3 u = p_b - p_a;
	const vec3 v = p_c - p_a;
	const float size = max(max(abs(u.x), max(abs(u.y), abs(u.z))), max(abs(v.x), max(abs(v.y), abs(v.z))));
	const vec3 normal = size > 0.0 ? cross(u / size, v / size) : vec3(0.0);
	const float length_normal = length(normal);
	const vec3 unit = length_normal > 0.0 ? normal / length_normal : vec3(0.0);
	return vec4(unit, -dot(unit, p_a));
}

/// +1 when the whole light lies in front of the face, -1 when behind it, 0 when it is divided.
int count_find_light_side(CountViewConstants p_view, vec4 p_plane) {
	const float SIDE_TOLERANCE_SIZES = 2.5e-7;
	const float SIDE_TOLERANCE_COSINE = 1e-6;
	const bool is_directional = p_view.is_directional != 0u;
	const float reach = p_view.disc_radius * (is_directional ? length(p_plane.xy) : 1.0);
	const float tolerance = is_directional ? SIDE_TOLERANCE_COSINE
										   : SIDE_TOLERANCE_SIZES * p_view.scene_size_m;
	const float side = count_light_side(p_view, p_plane.xyz, p_plane.w);
	return side > reach + tolerance ? 1 : (side < -reach - tolerance ? -1 : 0);
}

/// Signed weight from the sides of the faces; p_kind: EDGE_COUNT_HAS_FACE1, _DOUBLE_SIDED.
int count_sum_weights(bool p_is_facing0, bool p_is_facing1, int p_kind) {
	const int first = p_is_facing0 ? 1 : -1;
	const int sum = first - (p_is_facing1 ? 1 : -1);
	const int both = (p_kind & EDGE_COUNT_DOUBLE_SIDED) != 0 ? sum : sum / 2;
	return (p_kind & EDGE_COUNT_HAS_FACE1) != 0 ? both : first;
}

/// Shortens the part of a segment that is kept, from x to y, to where a quantity is not below 0: linear
/// between its values at the ends.
void keep_count_part(float p_at_a, float p_at_b, inout vec2 r_part) {
	const float at = p_at_a / (p_at_a - p_at_b);
	r_part.x = p_at_a < 0.0 ? (p_at_b < 0.0 ? 2.0 : max(r_part.x, at)) : r_part.x;
	r_part.y = p_at_a >= 0.0 && p_at_b < 0.0 ? min(r_part.y, at) : r_part.y;
}

/// A point of a segment where it is cut off: exactly there, as x' and y' may be a thousand.
vec3 count_cut_point(CountViewConstants p_view, vec3 p_a, vec3 p_b, float p_at) {
	const vec2 xy = mix(p_a.xy, p_b.xy, p_at);
	return vec3(xy, max(p_view.near_m, p_view.least_slope * max(abs(xy.x), abs(xy.y))));
}

/// The record of an edge between two points of the view, as its first face winds. False where no
/// receiver counts it: the light lies wholly on one side of both faces, or the edge before the near
/// plane or far aside. A boundary edge is always kept.
bool make_count_record(CountViewConstants p_view, vec3 p_a, vec3 p_b, vec4 p_plane0, vec4 p_plane1,
		int p_kind, out CountEdgeRecord r_record) {
	const bool has_face1 = (p_kind & EDGE_COUNT_HAS_FACE1) != 0;
	const int side = count_find_light_side(p_view, p_plane0);
	const bool is_one_sided = has_face1 && side != 0 && side == count_find_light_side(p_view, p_plane1);
	const int weight = count_sum_weights(count_light_side(p_view, p_plane0.xyz, p_plane0.w) > 0.0,
			count_light_side(p_view, p_plane1.xyz, p_plane1.w) > 0.0, p_kind);
	vec3 a = p_a;
	vec3 b = p_b;
	vec2 part = vec2(0.0, 1.0);
	if (p_view.is_directional == 0u) {
		const vec2 aside_a = p_view.least_slope * p_a.xy;
		const vec2 aside_b = p_view.least_slope * p_b.xy;
		keep_count_part(p_a.z - p_view.near_m, p_b.z - p_view.near_m, part);
		keep_count_part(p_a.z - aside_a.x, p_b.z - aside_b.x, part);
		keep_count_part(p_a.z + aside_a.x, p_b.z + aside_b.x, part);
		keep_count_part(p_a.z - aside_a.y, p_b.z - aside_b.y, part);
		keep_count_part(p_a.z + aside_a.y, p_b.z + aside_b.y, part);
		a = part.x > 0.0 ? count_cut_point(p_view, p_a, p_b, part.x) : a;
		b = part.y < 1.0 ? count_cut_point(p_view, p_a, p_b, part.y) : b;
	}
	const vec3 warped_a = count_warp(p_view, a);
	const vec3 warped_b = count_warp(p_view, b);
	r_record.a_bx = vec4(warped_a, warped_b.x);
	r_record.by_bw_weight_kind = vec4(warped_b.yz, float(weight), float(p_kind));
	r_record.plane0 = p_plane0;
	r_record.plane1 = p_plane1;
	return !is_one_sided && part.x <= part.y;
}

#endif
