// Which edges may matter to any receiver of a box: one test for the blocks' lists and for the groups
// of a resolve. Never leaves out an edge that adds something.
#ifndef COUNT_CULL_INC_GLSL
#define COUNT_CULL_INC_GLSL

#include "shadow_edge_count/count_classify_inc.glsl"

// What an edge is to the receivers of a box: a sum of these, and its weight where all of them see the
// same.
const uint COUNT_USE_AREA = 1u;	  // its fin may cover part of the light
const uint COUNT_USE_CENTER = 2u; // it may lie between a receiver and its reference texel
const uint COUNT_USE_ONE_WEIGHT = 4u;
const uint COUNT_WEIGHT_SHIFT = 3u;
const int COUNT_WEIGHT_BIAS = 2;

/// Receivers in (x', y', w).
struct CountBox {
	vec3 center;
	vec3 half_size;
	float reach; // half width of a fin per unit of w
	bool is_bounded; // false: the light's disc reaches behind its plane, any edge may matter
	float center_distance; // how far a reference texel may be
	float side_margin;	   // of a face's side, in the units of its test
};

CountBox make_count_box(CountViewConstants p_view, vec3 p_least, vec3 p_greatest) {
	const float SMALLEST_COSINE = 0.2;
	const float REFERENCE_TEXELS = 2.2; // the far corner of 3 x 3, from a place in the middle one
	const float SIDE_MARGIN_SIZES = 2.5e-4;
	CountBox box;
	box.center = 0.5 * (p_least + p_greatest);
	// A little more than half, for the rounding of the centre.
	box.half_size = 0.5001 * (p_greatest - p_least) + 1e-6 * abs(box.center);
	const vec2 far = abs(box.center.xy) + box.half_size.xy;
	const float square = dot(far, far);
	// The disc faces its receiver: at an angle off the axis its image is longer, and more so nearby.
	const float steepest = min(sqrt(square), 1.0); // where x / (1 + x^2) is greatest
	const float cosine = inversesqrt(1.0 + square) -
			p_view.disc_radius * (box.center.z + box.half_size.z) * steepest /
					(1.0 + steepest * steepest);
	const bool is_directional = p_view.is_directional != 0u;
	box.is_bounded = is_directional || cosine >= SMALLEST_COSINE;
	box.reach = p_view.disc_radius / (is_directional ? 1.0 : max(cosine, SMALLEST_COSINE));
	const vec2 texel = 2.0 * p_view.half_extent / vec2(p_view.map_size_px);
	box.center_distance = REFERENCE_TEXELS * max(texel.x, texel.y);
	box.side_margin =
			SIDE_MARGIN_SIZES * p_view.scene_size_m * (is_directional ? 1.0 : box.center.z);
	return box;
}

/// +1 or -1 where all receivers are on that side of the face, else 0.
int find_count_side(CountViewConstants p_view, CountBox p_box, vec4 p_plane) {
	const bool is_directional = p_view.is_directional != 0u;
	// n.r + d; perspective: times w.
	const float slope = is_directional ? -p_plane.z : p_plane.w;
	const float constant = is_directional ? p_plane.z * p_view.depth_far_m + p_plane.w : p_plane.z;
	const float side = dot(vec3(p_plane.xy, slope), p_box.center) + constant;
	const float range = dot(abs(vec3(p_plane.xy, slope)), p_box.half_size) + p_box.side_margin;
	return side > range ? 1 : (side < -range ? -1 : 0);
}

CountEdgeBundle make_count_bundle(CountEdgeRecord p_edge) {
	const vec2 a = p_edge.a_bx.xy;
	const vec2 b = vec2(p_edge.a_bx.w, p_edge.by_bw_weight_kind.x);
	return CountEdgeBundle(vec4(min(a, b), max(a, b)),
			vec4(max(p_edge.a_bx.z, p_edge.by_bw_weight_kind.y), 0.0, 0.0, 0.0));
}

CountEdgeBundle join_count_bundles(CountEdgeBundle p_one, CountEdgeBundle p_other) {
	return CountEdgeBundle(vec4(min(p_one.least_greatest_xy.xy, p_other.least_greatest_xy.xy),
								   max(p_one.least_greatest_xy.zw, p_other.least_greatest_xy.zw)),
			max(p_one.greatest_w, p_other.greatest_w));
}

/// False: none of the bundle's edges adds anything to any receiver of the box.
bool may_use_bundle(CountViewConstants p_view, CountBox p_box, CountEdgeBundle p_bundle) {
	const float above = p_bundle.greatest_w.x - (p_box.center.z - p_box.half_size.z);
	const vec4 sides = p_bundle.least_greatest_xy;
	const vec2 gap = max(max(sides.xy - p_box.center.xy, p_box.center.xy - sides.zw) - p_box.half_size.xy,
			vec2(0.0));
	const float reach = max(p_box.reach * above, p_box.center_distance);
	return !p_box.is_bounded || (above > 0.0 && dot(gap, gap) <= reach * reach);
}

/// COUNT_USE_*; 0: the edge adds nothing to any receiver of the box.
uint find_count_use(CountViewConstants p_view, CountBox p_box, CountEdgeRecord p_edge) {
	const vec3 a = p_edge.a_bx.xyz;
	const vec3 b = vec3(p_edge.a_bx.w, p_edge.by_bw_weight_kind.xy);
	const float above = max(a.z, b.z) - (p_box.center.z - p_box.half_size.z);
	const vec2 way = b.xy - a.xy;
	const vec2 to_center = p_box.center.xy - a.xy;
	const float share = clamp(dot(to_center, way) / max(dot(way, way), 1e-37), 0.0, 1.0);
	// From the box, as a disc about its centre.
	const float distance = length(to_center - share * way) - length(p_box.half_size.xy);
	const int kind = int(p_edge.by_bw_weight_kind.w);
	const bool has_face1 = (kind & EDGE_COUNT_HAS_FACE1) != 0;
	const int side0 = find_count_side(p_view, p_box, p_edge.plane0);
	const int side1 = find_count_side(p_view, p_box, p_edge.plane1);
	const bool has_one_weight = side0 != 0 && (side1 != 0 || !has_face1);
	const int weight = count_sum_weights(side0 > 0, side1 > 0, kind);
	const bool is_nearer = above > 0.0 || !p_box.is_bounded;
	const bool is_in_reach = distance <= p_box.reach * above || !p_box.is_bounded;
	const bool is_beside =
			p_edge.by_bw_weight_kind.z != 0.0 && distance <= p_box.center_distance;
	const bool has_weight = !has_one_weight || weight != 0;
	const uint use = (p_view.disc_radius > 0.0 && is_in_reach && has_weight ? COUNT_USE_AREA : 0u) |
			(is_beside ? COUNT_USE_CENTER : 0u) |
			(has_one_weight ? COUNT_USE_ONE_WEIGHT : 0u) |
			uint(weight + COUNT_WEIGHT_BIAS) << COUNT_WEIGHT_SHIFT;
	return is_nearer && (use & (COUNT_USE_AREA | COUNT_USE_CENTER)) != 0u ? use : 0u;
}

#endif
