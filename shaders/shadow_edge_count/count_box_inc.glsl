// Tests whether an edge may matter to any receiver of a box, for the lists of leaves and for the subgroups of a
// resolve. It never rejects an edge that contributes.
//
// A point q of an edge that hides the point Y of the light's disc from a receiver P is at q = (1 - d) P + d Y, with
// |Y| <= R and d as in CountReceiver; the origin is the light's centre. If the receivers are on one side of a plane,
// the height of q above it is an upper bound of d: a linear function of q, positive where q may matter (`above`). If
// they are on one side of a plane through the light's centre, q is at most d R beyond it: also linear, positive where q
// cannot matter (`outside`). Four such planes bound the box's rectangle in x' and y'. The fifth is the plane through
// the light's centre and the edge itself. An edge is rejected if one of these functions rejects both its ends:
// separating axes between the edge and the rectangle, widened by d R.
#ifndef COUNT_BOX_INC_GLSL
#define COUNT_BOX_INC_GLSL

#include "shadow_edge_count/count_classify_inc.glsl"

/// (x', y', w) of a point in light space. Its z must be above 0, except for a directional light.
vec3 warp_to_frame(CountFrame p_frame, float p_depth_far_m, vec3 p_point) {
	const vec3 r = vec3(dot(p_frame.x, p_point), dot(p_frame.y, p_point), dot(p_frame.z, p_point));
	return IS_DIRECTIONAL ? vec3(r.xy, p_depth_far_m - r.z) : vec3(r.xy, 1.0) / r.z;
}

/// Bounds of receivers in one frame, see CountLeaf. Empty if the lower bound of x' exceeds the upper one.
struct CountBounds {
	vec2 minimum;	   // of (x', y')
	vec2 maximum; // of (x', y')
	vec2 slope;
	vec2 range; // of w - slope.(x', y')
	vec2 w_range;
};

CountBounds make_count_bounds() {
	const vec2 none = vec2(COUNT_FAR, -COUNT_FAR);
	return CountBounds(vec2(COUNT_FAR), vec2(-COUNT_FAR), vec2(0.0), none, none);
}

/// Adds a receiver at p_warped (x', y', w) to bounds whose slope is set.
void add_to_bounds(vec3 p_warped, bool p_is_selected, inout CountBounds r_bounds) {
	const float range = p_warped.z - dot(r_bounds.slope, p_warped.xy);
	r_bounds.minimum = p_is_selected ? min(r_bounds.minimum, p_warped.xy) : r_bounds.minimum;
	r_bounds.maximum = p_is_selected ? max(r_bounds.maximum, p_warped.xy) : r_bounds.maximum;
	r_bounds.range.x = p_is_selected ? min(r_bounds.range.x, range) : r_bounds.range.x;
	r_bounds.range.y = p_is_selected ? max(r_bounds.range.y, range) : r_bounds.range.y;
	r_bounds.w_range.x = p_is_selected ? min(r_bounds.w_range.x, p_warped.z) : r_bounds.w_range.x;
	r_bounds.w_range.y = p_is_selected ? max(r_bounds.w_range.y, p_warped.z) : r_bounds.w_range.y;
}

/// Replaces the plane by one across the frame's axis if that has the narrower range. A plane that the light sees nearly edge-on
/// is steep, and a range about it says little about the receivers.
CountBounds choose_flatter(CountBounds p_bounds) {
	const bool is_flat = p_bounds.range.y - p_bounds.range.x <= p_bounds.w_range.y - p_bounds.w_range.x;
	CountBounds bounds = p_bounds;
	bounds.slope = is_flat ? bounds.slope : vec2(0.0);
	bounds.range = is_flat ? bounds.range : bounds.w_range;
	return bounds;
}

CountBounds unpack_count_bounds(CountLeaf p_leaf) {
	return CountBounds(p_leaf.min_max.xy, p_leaf.min_max.zw, p_leaf.slope_range.xy, p_leaf.slope_range.zw,
			vec2(p_leaf.minimum_w.w, p_leaf.maximum_w.w));
}

/// Receivers of one leaf, prepared for tests of edges in light space. q and d: see the head of this file.
struct CountBox {
	vec4 above;		 // d <= dot(above, (q, 1))
	vec4 below;		 // d >= dot(below, (q, 1))
	float smooth_fraction; // see find_smooth_fraction
	vec4 outside[4]; // rejects q where dot(outside, (q, 1)) > 0
	// Rectangle and plane of the receivers, for the fifth plane and for find_count_side.
	CountFrame frame;
	vec2 center;
	vec2 half_size;
	vec2 slope;
	vec2 range; // middle and half width
	float radius; // R
	float margin; // rounding error of distances from planes
	float depth_far_m;
	float distance; // of the leaf, see CountLeaf
	bool is_wide; // see EDGE_COUNT_LEAF_IS_WIDE: nothing is rejected
};

/// Upper bound of |normal.Y| for points Y of the discs of all receivers P that have normal.P >= p_min. Y is
/// perpendicular to P, and |P| is at most p_longest.
float find_tilt(float p_radius, vec3 p_normal, float p_min, float p_longest) {
	const float along = max(p_min, 0.0) / p_longest;
	return p_radius * sqrt(max(dot(p_normal, p_normal) - along * along, 0.0));
}

/// CountBox::smooth_fraction: the d from which on the projection of an edge onto the disc moves by at most
/// CountLightConstants::interpolation, in R, from the middle of the box to its border. If a receiver moves by h across
/// the light's direction, the projection moves by h (1 - d) / d. If it moves along that direction by a fraction f of
/// its distance, the projection moves by less than f R / d. Directional: by h / d and, with f in metres, by f R / d.
float find_smooth_fraction(CountLightConstants p_light, CountBounds p_bounds) {
	const float half_size = 0.5 * length(p_bounds.maximum - p_bounds.minimum);
	const float half_range = 0.5 * (p_bounds.w_range.y - p_bounds.w_range.x);
	const float inverse_radius = 1.0 / max(p_light.disc_radius, 1e-37);
	const float inverse_w = 1.0 / max(p_bounds.w_range.x, 1e-37);
	const float most = p_light.interpolation;
	const bool is_known = most > 0.0 && (IS_DIRECTIONAL || p_bounds.w_range.x > 0.0);
	const float across = half_size * inverse_radius * (IS_DIRECTIONAL ? 1.0 : inverse_w);
	const float along = half_range * (IS_DIRECTIONAL ? 1.0 : inverse_w);
	return is_known ? (across + along) / (IS_DIRECTIONAL ? most : most + across) : COUNT_FAR;
}

// At a height h above the receivers' plane, an edge is out of reach from R h / (1 - 2 tilt) on, in the direction in which
// the plane rises.
const float MAX_TILT = 0.25;

/// `above` and `below` of a directional light, whose d is in metres.
void bound_directional_fraction(CountBounds p_bounds, inout CountBox r_box) {
	const float tilt = r_box.radius * length(p_bounds.slope);
	r_box.above = tilt < MAX_TILT ? vec4(-p_bounds.slope, -1.0, r_box.depth_far_m - p_bounds.range.x) / (1.0 - tilt)
								  : vec4(0.0, 0.0, -1.0, r_box.depth_far_m - p_bounds.w_range.x);
	r_box.below = vec4(-p_bounds.slope, -1.0, r_box.depth_far_m - p_bounds.range.y) / (1.0 + tilt);
}

/// `above` and `below` of a point light. They are from the receivers' plane. If that is not flat or is tilted too much
/// towards the disc, `above` is from a plane across the frame's axis; if that fails too, 1, which d never exceeds. Where no
/// plane is possible, `below` is a value below any d.
void bound_fraction(CountBounds p_bounds, inout CountBox r_box) {
	const vec2 far = max(abs(p_bounds.minimum), abs(p_bounds.maximum));
	const float min_w = p_bounds.w_range.x;
	const bool is_known = min_w > 0.0;
	const float longest = is_known ? sqrt(1.0 + dot(far, far)) / min_w : 1e37;
	// The receivers' plane w = slope.(x', y') + range.x is n.P = 1. No receiver has n.P > 1, so n.q <= 1 - d + d tilt. All
	// have n.P >= minimum, so n.q >= (1 - d) minimum - d tilt.
	const vec3 normal = p_bounds.slope.x * r_box.frame.x + p_bounds.slope.y * r_box.frame.y +
			p_bounds.range.x * r_box.frame.z;
	const float minimum = 1.0 - (p_bounds.range.y - p_bounds.range.x) / max(min_w, 1e-37);
	const float tilt = find_tilt(r_box.radius, normal, minimum, longest);
	const vec3 across = min_w * r_box.frame.z;
	const float across_tilt = find_tilt(r_box.radius, across, min_w / max(p_bounds.w_range.y, 1e-37), longest);
	r_box.above = vec4(vec3(0.0), 1.0);
	if (is_known && tilt < MAX_TILT) {
		r_box.above = vec4(-normal, 1.0) / (1.0 - tilt);
	} else if (is_known && across_tilt < MAX_TILT) {
		r_box.above = vec4(-across, 1.0) / (1.0 - across_tilt);
	}
	r_box.below = is_known && minimum > 0.0 ? vec4(-normal, minimum) / (minimum + tilt) : vec4(vec3(0.0), -COUNT_FAR);
}

/// p_radius: R; 0 for tests of what may be between the receivers and the light's centre. p_distance: of the leaf.
CountBox make_count_box(CountLightConstants p_light, float p_radius, CountFrame p_frame, CountBounds p_bounds,
		float p_distance, bool p_is_wide) {
	const float WIDENING = 1.0001; // for rounding of the centre
	const float MARGIN = 2e-6;
	CountBox box;
	box.frame = p_frame;
	box.center = 0.5 * (p_bounds.minimum + p_bounds.maximum);
	// For rounding of the receivers' coordinates. Those of a point light are tangents of small angles.
	const vec2 rounding = 1e-6 * (IS_DIRECTIONAL ? abs(box.center) : vec2(1.0) + abs(box.center));
	box.half_size = 0.5 * WIDENING * (p_bounds.maximum - p_bounds.minimum) + rounding;
	box.slope = p_bounds.slope;
	box.range = 0.5 * vec2(p_bounds.range.x + p_bounds.range.y, WIDENING * (p_bounds.range.y - p_bounds.range.x));
	box.radius = p_radius;
	box.depth_far_m = p_light.depth_far_m;
	box.distance = p_distance;
	box.is_wide = p_is_wide;
	box.smooth_fraction = p_is_wide ? COUNT_FAR : find_smooth_fraction(p_light, p_bounds);
	const vec2 minimum = box.center - box.half_size;
	const vec2 maximum = box.center + box.half_size;
	const vec3 x = p_frame.x;
	const vec3 y = p_frame.y;
	const vec3 z = p_frame.z;
	if (IS_DIRECTIONAL) {
		bound_directional_fraction(p_bounds, box);
		box.margin = MARGIN * (length(max(abs(minimum), abs(maximum))) + p_light.depth_far_m);
		box.outside[0] = vec4(x, -maximum.x);
		box.outside[1] = vec4(-x, minimum.x);
		box.outside[2] = vec4(y, -maximum.y);
		box.outside[3] = vec4(-y, minimum.y);
	} else {
		bound_fraction(p_bounds, box);
		box.margin = MARGIN;
		box.outside[0] = vec4((x - maximum.x * z) * inversesqrt(1.0 + maximum.x * maximum.x), 0.0);
		box.outside[1] = vec4((minimum.x * z - x) * inversesqrt(1.0 + minimum.x * minimum.x), 0.0);
		box.outside[2] = vec4((y - maximum.y * z) * inversesqrt(1.0 + maximum.y * maximum.y), 0.0);
		box.outside[3] = vec4((minimum.y * z - y) * inversesqrt(1.0 + minimum.y * minimum.y), 0.0);
	}
	for (int i = 0; i < 4; ++i) {
		// q may be d R beyond a plane, and d <= above.
		box.outside[i] -= box.radius * box.above;
	}
	return box;
}

float find_linear(vec4 p_function, vec3 p_point) {
	return dot(p_function.xyz, p_point) + p_function.w;
}

/// False if nothing in the node can be between a receiver of the box and a point of the disc that its radius describes.
bool is_node_in_reach(CountBox p_box, CountNode p_node) {
	const vec3 center = p_node.center_first_distance.xyz;
	const vec3 half_size = p_node.half_size_end_distance.xyz;
	bool is_in_reach = find_linear(p_box.above, center) + dot(abs(p_box.above.xyz), half_size) > -p_box.margin;
	for (int i = 0; i < 4; ++i) {
		is_in_reach = is_in_reach &&
				find_linear(p_box.outside[i], center) - dot(abs(p_box.outside[i].xyz), half_size) <= p_box.margin;
	}
	return is_in_distance_range(p_box.distance, p_node) && (is_in_reach || p_box.is_wide);
}

/// Lower bound of the distance of the box's receivers from the plane through the light's centre and an edge, divided by
/// their distance along the frame's axis (directional: in metres). 0 if they are on both sides.
float find_min_distance(CountBox p_box, vec3 p_a, vec3 p_b) {
	const float MIN_SINE = 1e-4; // of the angle between p_a and p_b; below, rounding dominates the plane's normal
	vec2 across;
	float middle;
	if (IS_DIRECTIONAL) {
		const vec2 edge_direction = p_b.xy - p_a.xy;
		across = vec2(edge_direction.y, -edge_direction.x) * inversesqrt(max(dot(edge_direction, edge_direction), 1e-37));
		middle = dot(across, p_box.center - p_a.xy);
	} else {
		const vec3 normal = cross(p_a, p_b);
		const float square = dot(normal, normal);
		const bool is_known = square > MIN_SINE * MIN_SINE * dot(p_a, p_a) * dot(p_b, p_b);
		const vec3 unit = is_known ? normal * inversesqrt(max(square, 1e-37)) : vec3(0.0);
		across = vec2(dot(unit, p_box.frame.x), dot(unit, p_box.frame.y));
		middle = dot(across, p_box.center) + dot(unit, p_box.frame.z);
	}
	return max(abs(middle) - dot(abs(across), p_box.half_size) - p_box.margin, 0.0);
}

/// False if the edge hides nothing of the light from any receiver of the box.
bool is_edge_in_reach(CountBox p_box, vec3 p_a, vec3 p_b) {
	// Clip the edge to where `above` is positive.
	const float above_a = find_linear(p_box.above, p_a);
	const float above_b = find_linear(p_box.above, p_b);
	const float fraction = above_a / (above_a - above_b);
	const vec3 a = above_a < 0.0 && above_b > 0.0 ? mix(p_a, p_b, fraction) : p_a;
	const vec3 b = above_b < 0.0 && above_a > 0.0 ? mix(p_a, p_b, fraction) : p_b;
	bool is_in_reach = above_a > 0.0 || above_b > 0.0;
	for (int i = 0; i < 4; ++i) {
		is_in_reach = is_in_reach &&
				(find_linear(p_box.outside[i], a) <= 0.0 || find_linear(p_box.outside[i], b) <= 0.0);
	}
	const float side_distance = find_min_distance(p_box, a, b);
	const vec2 widening = p_box.radius * max(vec2(above_a, above_b), 0.0);
	const vec2 depth = vec2(dot(p_box.frame.z, a), dot(p_box.frame.z, b));
	// With n the unit normal of the fifth plane, which contains q: (1 - d) |n.P| = d |n.Y| <= d R. With h the distance
	// of P along the frame's axis: |n.P| >= h side_distance and (1 - d) h >= depth - d R. d R is at most the widening.
	const vec2 beyond = IS_DIRECTIONAL ? vec2(side_distance) - widening
											 : (depth - widening) * side_distance - widening;
	return p_box.is_wide || (is_in_reach && (beyond.x <= 0.0 || beyond.y <= 0.0));
}

/// Lower bound of d where an edge hides something of the light from any receiver of the box. COUNT_FAR if it hides
/// nothing.
float find_min_fraction(CountBox p_box, vec3 p_a, vec3 p_b) {
	vec2 interval = vec2(0.0, 1.0); // range along the edge, above the receivers and inside the widened rectangle
	const float above_a = find_linear(p_box.above, p_a);
	const float above_b = find_linear(p_box.above, p_b);
	const float entry = above_a / (above_a - above_b);
	interval.x = above_a < 0.0 ? entry : 0.0;
	interval.y = above_b < 0.0 ? entry : 1.0;
	for (int i = 0; i < 4; ++i) {
		const float a = find_linear(p_box.outside[i], p_a);
		const float b = find_linear(p_box.outside[i], p_b);
		const float fraction = a / (a - b);
		interval.x = a > 0.0 ? max(interval.x, fraction) : interval.x;
		interval.y = b > 0.0 ? min(interval.y, fraction) : interval.y;
	}
	const float below_a = find_linear(p_box.below, p_a);
	const float below_b = find_linear(p_box.below, p_b);
	return p_box.is_wide ? -COUNT_FAR : interval.x <= interval.y
			? min(mix(below_a, below_b, interval.x), mix(below_a, below_b, interval.y))
			: COUNT_FAR;
}

/// +1 if all receivers are in front of the face's plane, -1 if all are behind it, else 0.
int find_count_side(CountBox p_box, vec4 p_plane) {
	// The plane's function n.P + c, linear in x', y' and w. Point lights: divided by P's distance along the frame's
	// axis.
	const vec3 normal = vec3(dot(p_plane.xyz, p_box.frame.x), dot(p_plane.xyz, p_box.frame.y),
			dot(p_plane.xyz, p_box.frame.z));
	const float per_w = IS_DIRECTIONAL ? -normal.z : p_plane.w;
	const float constant = IS_DIRECTIONAL ? normal.z * p_box.depth_far_m + p_plane.w : normal.z;
	const vec2 change = normal.xy + per_w * p_box.slope;
	const float side = dot(change, p_box.center) + per_w * p_box.range.x + constant;
	const float w = dot(abs(p_box.slope), abs(p_box.center) + p_box.half_size) + abs(p_box.range.x) + p_box.range.y;
	const float size = IS_DIRECTIONAL ? 1.0 : 1.0 + abs(per_w) * w; // of the terms, for their rounding
	const float reach = dot(abs(change), p_box.half_size) + abs(per_w) * p_box.range.y + p_box.margin * size;
	return p_box.is_wide ? 0 : (side > reach ? 1 : (side < -reach ? -1 : 0));
}

/// True if the face may cross the way between two receivers of the box, whose radius must be 0.
bool is_local_face(CountBox p_box, CountFaceRecord p_face, vec4 p_plane) {
	const vec3 a = uintBitsToFloat(p_face.a_kind.xyz);
	const vec3 b = uintBitsToFloat(p_face.b_first_distance.xyz);
	const vec3 c = uintBitsToFloat(p_face.c_end_distance.xyz);
	const float min_in_front =
			min(find_linear(p_box.below, a), min(find_linear(p_box.below, b), find_linear(p_box.below, c)));
	const float max_behind =
			max(find_linear(p_box.above, a), max(find_linear(p_box.above, b), find_linear(p_box.above, c)));
	bool is_within = find_count_side(p_box, p_plane) == 0 && min_in_front <= p_box.margin && max_behind >= -p_box.margin;
	for (int i = 0; i < 4; ++i) {
		is_within = is_within &&
				min(find_linear(p_box.outside[i], a), min(find_linear(p_box.outside[i], b), find_linear(p_box.outside[i], c))) <=
						p_box.margin;
	}
	return p_box.is_wide || is_within;
}

/// The position of a point relative to the light's discs that face the receivers of the box: +1 in front of all of
/// them, -1 behind all, 0 in front of some. Always +1 for a directional light.
int find_light_side(CountBox p_box, vec3 p_point) {
	const vec2 across = vec2(dot(p_box.frame.x, p_point), dot(p_box.frame.y, p_point));
	const float middle = dot(across, p_box.center) + dot(p_box.frame.z, p_point);
	const float reach = dot(abs(across), p_box.half_size);
	return IS_DIRECTIONAL ? 1 : (p_box.is_wide ? 0 : (middle > reach ? 1 : (middle < -reach ? -1 : 0)));
}

// An entry of an edge list: an edge index in the low 26 bits, and above it a packed weight, which is COUNT_HAS_WEIGHT
// and the weight (-2..2) if all receivers of the box see the same one, else 0.
const uint COUNT_HAS_WEIGHT = 1u;
const uint COUNT_WEIGHT_SHIFT = 1u;
const int COUNT_WEIGHT_BIAS = 2;
const uint COUNT_PACKED_WEIGHT_SHIFT = uint(EDGE_COUNT_EDGE_BITS);
const uint COUNT_EDGE_MASK = (1u << COUNT_PACKED_WEIGHT_SHIFT) - 1u;
const uint COUNT_ADDS_NOTHING = COUNT_HAS_WEIGHT | uint(COUNT_WEIGHT_BIAS) << COUNT_WEIGHT_SHIFT;

/// The packed weight of an edge for a box: 0 if its receivers may see different weights. p_plane1 is ignored if there
/// is no second face.
uint find_packed_weight(CountBox p_box, CountEdgeKind p_kind, vec4 p_plane0, vec4 p_plane1) {
	const int side0 = find_count_side(p_box, p_plane0);
	const int side1 = find_count_side(p_box, p_kind.is_inconsistent ? -p_plane1 : p_plane1);
	const bool is_known = side0 != 0 && (side1 != 0 || !p_kind.has_face1);
	const int weight = count_sum_weights(side0 > 0, side1 > 0, p_kind);
	return is_known ? COUNT_HAS_WEIGHT | uint(weight + COUNT_WEIGHT_BIAS) << COUNT_WEIGHT_SHIFT : 0u;
}

/// The weight of a packed weight that has COUNT_HAS_WEIGHT.
int unpack_weight(uint p_packed_weight) {
	return int(p_packed_weight >> COUNT_WEIGHT_SHIFT & 7u) - COUNT_WEIGHT_BIAS;
}

#endif
