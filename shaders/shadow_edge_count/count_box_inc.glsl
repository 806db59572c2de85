// Which edges may matter to any receiver of a box: one test for blocks' lists and for groups of a resolve.
// It never rejects an edge that adds something.
//
// A point q of an edge that hides X from a receiver P is at q = (1 - s) P + s X, |X| <= R. Where the
// receivers are on one side of a plane, q's height above it bounds s: a linear function of q, above 0 where q
// may matter (`above`). And where they are on one side of a plane through the light's centre, q is at most
// s R beyond it: again linear, above 0 where q cannot matter (`outside`). Four such planes bound the box's
// rectangle; the fifth is the plane through the light's centre and the edge itself. So an edge is rejected
// when one of these functions rejects both its ends: separating axes for the rectangle and the widening fin.
#ifndef COUNT_BOX_INC_GLSL
#define COUNT_BOX_INC_GLSL

#include "shadow_edge_count/count_classify_inc.glsl"

/// Receivers in one view: see CountBlockBox. None where a least is greater.
struct CountBounds {
	vec2 least;
	vec2 greatest;
	vec2 slope;
	vec2 range;
};

const float COUNT_FAR = 3e38;

CountBounds make_count_bounds() {
	return CountBounds(vec2(COUNT_FAR), vec2(-COUNT_FAR), vec2(0.0), vec2(COUNT_FAR, -COUNT_FAR));
}

bool is_count_bounds_empty(CountBounds p_bounds) {
	return p_bounds.least.x > p_bounds.greatest.x;
}

/// The range of w - slope.(x', y') about another plane. Not of empty bounds.
vec2 find_range_about(CountBounds p_bounds, vec2 p_slope) {
	const vec2 change = p_bounds.slope - p_slope;
	const float middle = dot(change, 0.5 * (p_bounds.least + p_bounds.greatest));
	const float half_width = dot(abs(change), 0.5 * (p_bounds.greatest - p_bounds.least));
	return p_bounds.range + vec2(middle - half_width, middle + half_width);
}

/// Least and greatest w.
vec2 find_w_range(CountBounds p_bounds) {
	return find_range_about(p_bounds, vec2(0.0));
}

/// Adds bounds of the same view, about the plane that the first ones have.
CountBounds join_count_bounds(CountBounds p_one, CountBounds p_other) {
	if (is_count_bounds_empty(p_one)) {
		return p_other;
	}
	const bool is_empty = is_count_bounds_empty(p_other);
	const vec2 range = find_range_about(p_other, p_one.slope);
	return CountBounds(min(p_one.least, p_other.least), max(p_one.greatest, p_other.greatest), p_one.slope,
			is_empty ? p_one.range : vec2(min(p_one.range.x, range.x), max(p_one.range.y, range.y)));
}

CountBounds unpack_count_bounds(CountBlockBox p_box) {
	return CountBounds(p_box.least_greatest.xy, p_box.least_greatest.zw, p_box.slope_range.xy,
			p_box.slope_range.zw);
}

/// The box, ready for tests in light space.
struct CountBox {
	vec4 above;		 // s <= dot(above, (q, 1))
	vec4 below;		 // s >= dot(below, (q, 1))
	float smooth_share; // s of edges that move at most CountLightConstants::interpolation R between receivers
	vec4 outside[4]; // rejects q where above 0
	// Rectangle and plane of the receivers, for the fifth plane and for the sides of faces.
	CountViewConstants view;
	vec2 center;
	vec2 half_size;
	vec2 slope;
	vec2 range; // middle and half width
	float radius;
	float margin; // of the side of a face: what rounding may do
	float depth_far_m;
	bool is_directional;
};

/// The most that a point X of any receiver's disc reaches towards a plane normal.P = 1 whose receivers have
/// normal.P >= p_least. X is at right angles to P, and |P| at most p_longest.
float find_tilt(float p_radius, vec3 p_normal, float p_least, float p_longest) {
	const float along = max(p_least, 0.0) / p_longest;
	return p_radius * sqrt(max(dot(p_normal, p_normal) - along * along, 0.0));
}

/// `above` of a point light: from the receivers' plane, or where the disc may reach below that from a plane
/// across the view, or else 1, which s never exceeds.
vec4 find_above(CountLightConstants p_light, CountViewConstants p_view, CountBounds p_bounds, vec2 p_w_range) {
	const float MOST_TILT = 0.7;
	const vec2 far = max(abs(p_bounds.least), abs(p_bounds.greatest));
	const float least_w = p_w_range.x;
	const float longest = least_w > 0.0 ? sqrt(1.0 + dot(far, far)) / least_w : 1e37;
	const vec3 own_normal = p_bounds.slope.x * p_view.axis_x.xyz + p_bounds.slope.y * p_view.axis_y.xyz +
			p_bounds.range.x * p_view.axis_z.xyz;
	const float own_least = 1.0 - (p_bounds.range.y - p_bounds.range.x) / max(least_w, 1e-37);
	const float own_tilt = find_tilt(p_light.disc_radius, own_normal, own_least, longest);
	const vec3 across_normal = least_w * p_view.axis_z.xyz;
	const float across_tilt =
			find_tilt(p_light.disc_radius, across_normal, least_w / max(p_w_range.y, 1e-37), longest);
	const bool is_flat = p_bounds.range.y - p_bounds.range.x <= p_w_range.y - p_w_range.x;
	if (least_w > 0.0 && is_flat && own_tilt < MOST_TILT) {
		return vec4(-own_normal, 1.0) / (1.0 - own_tilt);
	}
	if (least_w > 0.0 && across_tilt < MOST_TILT) {
		return vec4(-across_normal, 1.0) / (1.0 - across_tilt);
	}
	return vec4(vec3(0.0), 1.0);
}

/// `below` of a point light: from the receivers' plane, or less than any s.
vec4 find_below(CountLightConstants p_light, CountViewConstants p_view, CountBounds p_bounds, vec2 p_w_range) {
	const vec2 far = max(abs(p_bounds.least), abs(p_bounds.greatest));
	const float longest = sqrt(1.0 + dot(far, far)) / max(p_w_range.x, 1e-37);
	const vec3 normal = p_bounds.slope.x * p_view.axis_x.xyz + p_bounds.slope.y * p_view.axis_y.xyz +
			p_bounds.range.x * p_view.axis_z.xyz;
	const float least = 1.0 - (p_bounds.range.y - p_bounds.range.x) / max(p_w_range.x, 1e-37);
	const float tilt = find_tilt(p_light.disc_radius, normal, least, longest);
	return p_w_range.x > 0.0 && least > 0.0 ? vec4(-normal, least) / (least + tilt)
											: vec4(vec3(0.0), -COUNT_FAR);
}

/// CountBox::smooth_share. A receiver that moves by h across the light's direction moves the image of an edge on
/// the disc by h (1 - s) / s, and one that moves by a share t of its distance along it, by less than t R / s.
/// Directional: h / s and, t in metres, t R / s.
float find_smooth_share(CountLightConstants p_light, CountBounds p_bounds, vec2 p_w_range) {
	const float half_size = 0.5 * length(p_bounds.greatest - p_bounds.least);
	const float half_range = 0.5 * (p_w_range.y - p_w_range.x);
	const float inverse_radius = 1.0 / max(p_light.disc_radius, 1e-37);
	const float inverse_w = 1.0 / max(p_w_range.x, 1e-37);
	const float most = p_light.interpolation;
	const bool is_known = most > 0.0 && (p_light.is_directional != 0u || p_w_range.x > 0.0);
	const float across = half_size * inverse_radius * (p_light.is_directional != 0u ? 1.0 : inverse_w);
	const float along = half_range * (p_light.is_directional != 0u ? 1.0 : inverse_w);
	return is_known ? (across + along) / (p_light.is_directional != 0u ? most : most + across) : COUNT_FAR;
}

/// `above` of a directional light; s in metres.
vec4 find_above_directional(CountLightConstants p_light, CountBounds p_bounds, vec2 p_w_range) {
	const float MOST_TILT = 0.7;
	const float tilt = p_light.disc_radius * length(p_bounds.slope);
	const bool is_flat = p_bounds.range.y - p_bounds.range.x <= p_w_range.y - p_w_range.x;
	return is_flat && tilt < MOST_TILT
			? vec4(-p_bounds.slope, -1.0, p_light.depth_far_m - p_bounds.range.x) / (1.0 - tilt)
			: vec4(0.0, 0.0, -1.0, p_light.depth_far_m - p_w_range.x);
}

CountBox make_count_box(CountLightConstants p_light, CountViewConstants p_view, CountBounds p_bounds) {
	const float WIDENED = 1.0001; // for the rounding of the middle
	const float MARGIN = 2e-6;
	CountBox box;
	box.view = p_view;
	box.center = 0.5 * (p_bounds.least + p_bounds.greatest);
	box.half_size = 0.5 * WIDENED * (p_bounds.greatest - p_bounds.least) + 1e-6 * abs(box.center);
	box.slope = p_bounds.slope;
	box.range = 0.5 * vec2(p_bounds.range.x + p_bounds.range.y, WIDENED * (p_bounds.range.y - p_bounds.range.x));
	box.radius = p_light.disc_radius;
	box.depth_far_m = p_light.depth_far_m;
	box.is_directional = p_light.is_directional != 0u;
	const vec2 w_range = find_w_range(p_bounds);
	const vec2 least = box.center - box.half_size;
	const vec2 greatest = box.center + box.half_size;
	const vec3 x = p_view.axis_x.xyz;
	const vec3 y = p_view.axis_y.xyz;
	const vec3 z = p_view.axis_z.xyz;
	box.smooth_share = find_smooth_share(p_light, p_bounds, w_range);
	if (box.is_directional) {
		box.above = find_above_directional(p_light, p_bounds, w_range);
		box.below = vec4(-p_bounds.slope, -1.0, p_light.depth_far_m - p_bounds.range.y) /
				(1.0 + p_light.disc_radius * length(p_bounds.slope));
		box.margin = MARGIN * (length(max(abs(least), abs(greatest))) + p_light.depth_far_m);
		box.outside[0] = vec4(x, -greatest.x);
		box.outside[1] = vec4(-x, least.x);
		box.outside[2] = vec4(y, -greatest.y);
		box.outside[3] = vec4(-y, least.y);
	} else {
		box.above = find_above(p_light, p_view, p_bounds, w_range);
		box.below = find_below(p_light, p_view, p_bounds, w_range);
		box.margin = MARGIN;
		box.outside[0] = vec4((x - greatest.x * z) * inversesqrt(1.0 + greatest.x * greatest.x), 0.0);
		box.outside[1] = vec4((least.x * z - x) * inversesqrt(1.0 + least.x * least.x), 0.0);
		box.outside[2] = vec4((y - greatest.y * z) * inversesqrt(1.0 + greatest.y * greatest.y), 0.0);
		box.outside[3] = vec4((least.y * z - y) * inversesqrt(1.0 + least.y * least.y), 0.0);
	}
	for (int i = 0; i < 4; ++i) {
		box.outside[i] -= box.radius * box.above;
	}
	return box;
}

float find_linear(vec4 p_function, vec3 p_point) {
	return dot(p_function.xyz, p_point) + p_function.w;
}

/// False: none of the bundle's edges adds anything to any receiver of the box.
bool may_use_bundle(CountBox p_box, CountEdgeBundle p_bundle) {
	const vec3 center = p_bundle.center.xyz;
	const vec3 half_size = p_bundle.half_size.xyz;
	bool may_use = find_linear(p_box.above, center) + dot(abs(p_box.above.xyz), half_size) > 0.0;
	for (int i = 0; i < 4; ++i) {
		may_use = may_use &&
				find_linear(p_box.outside[i], center) - dot(abs(p_box.outside[i].xyz), half_size) <= 0.0;
	}
	return may_use;
}

/// Least distance of the box's receivers from the plane through the light's centre and an edge, as a part of
/// their distance along the view (directional: metres); 0 where they are on both sides.
float find_least_aside(CountBox p_box, vec3 p_a, vec3 p_b) {
	const float LEAST_SINE = 1e-4; // below, rounding decides where the plane is
	vec2 across;
	float middle;
	if (p_box.is_directional) {
		const vec2 way = p_b.xy - p_a.xy;
		across = vec2(way.y, -way.x) * inversesqrt(max(dot(way, way), 1e-37));
		middle = dot(across, p_box.center - p_a.xy);
	} else {
		const vec3 normal = cross(p_a, p_b);
		const float square = dot(normal, normal);
		const bool is_known = square > LEAST_SINE * LEAST_SINE * dot(p_a, p_a) * dot(p_b, p_b);
		const vec3 unit = is_known ? normal * inversesqrt(max(square, 1e-37)) : vec3(0.0);
		across = vec2(dot(unit, p_box.view.axis_x.xyz), dot(unit, p_box.view.axis_y.xyz));
		middle = dot(across, p_box.center) + dot(unit, p_box.view.axis_z.xyz);
	}
	return max(abs(middle) - dot(abs(across), p_box.half_size) - p_box.margin, 0.0);
}

/// False: the edge hides nothing from any receiver of the box.
bool is_edge_in_reach(CountBox p_box, vec3 p_a, vec3 p_b) {
	// Only the part above the receivers.
	const float above_a = find_linear(p_box.above, p_a);
	const float above_b = find_linear(p_box.above, p_b);
	const float share = above_a / (above_a - above_b);
	const vec3 a = above_a < 0.0 && above_b > 0.0 ? mix(p_a, p_b, share) : p_a;
	const vec3 b = above_b < 0.0 && above_a > 0.0 ? mix(p_a, p_b, share) : p_b;
	bool is_in_reach = above_a > 0.0 || above_b > 0.0;
	for (int i = 0; i < 4; ++i) {
		is_in_reach = is_in_reach &&
				(find_linear(p_box.outside[i], a) <= 0.0 || find_linear(p_box.outside[i], b) <= 0.0);
	}
	const float aside = find_least_aside(p_box, a, b);
	const vec2 fin = p_box.radius * max(vec2(above_a, above_b), 0.0);
	const vec2 depth = vec2(dot(p_box.view.axis_z.xyz, a), dot(p_box.view.axis_z.xyz, b));
	const vec2 beyond = p_box.is_directional ? vec2(aside) - fin : (depth - fin) * aside - fin;
	return is_in_reach && (beyond.x <= 0.0 || beyond.y <= 0.0);
}

/// The least s at which an edge hides something of a disc of any receiver in the box.
float find_least_share(CountBox p_box, vec3 p_a, vec3 p_b) {
	vec2 part = vec2(0.0, 1.0); // of the edge, above the receivers and within the rectangle and the widening fin
	const float above_a = find_linear(p_box.above, p_a);
	const float above_b = find_linear(p_box.above, p_b);
	const float entry = above_a / (above_a - above_b);
	part.x = above_a < 0.0 ? entry : 0.0;
	part.y = above_b < 0.0 ? entry : 1.0;
	for (int i = 0; i < 4; ++i) {
		const float a = find_linear(p_box.outside[i], p_a);
		const float b = find_linear(p_box.outside[i], p_b);
		const float share = a / (a - b);
		part.x = a > 0.0 ? max(part.x, share) : part.x;
		part.y = b > 0.0 ? min(part.y, share) : part.y;
	}
	const float below_a = find_linear(p_box.below, p_a);
	const float below_b = find_linear(p_box.below, p_b);
	return part.x <= part.y ? min(mix(below_a, below_b, part.x), mix(below_a, below_b, part.y)) : COUNT_FAR;
}

/// +1 or -1 where all receivers lie on that side of the face, else 0.
int find_count_side(CountBox p_box, vec4 p_plane) {
	// n.P + d; of a point light over P's distance along the view.
	const vec3 normal = vec3(dot(p_plane.xyz, p_box.view.axis_x.xyz), dot(p_plane.xyz, p_box.view.axis_y.xyz),
			dot(p_plane.xyz, p_box.view.axis_z.xyz));
	const float per_w = p_box.is_directional ? -normal.z : p_plane.w;
	const float constant = p_box.is_directional ? normal.z * p_box.depth_far_m + p_plane.w : normal.z;
	const vec2 change = normal.xy + per_w * p_box.slope;
	const float side = dot(change, p_box.center) + per_w * p_box.range.x + constant;
	const float w = dot(abs(p_box.slope), abs(p_box.center) + p_box.half_size) + abs(p_box.range.x) + p_box.range.y;
	const float size = p_box.is_directional ? 1.0 : 1.0 + abs(per_w) * w; // of the terms, for their rounding
	const float reach = dot(abs(change), p_box.half_size) + abs(per_w) * p_box.range.y + p_box.margin * size;
	return side > reach ? 1 : (side < -reach ? -1 : 0);
}

/// Where a point is for the light's discs that face the receivers of the box: +1 before all, -1 behind all of
/// them, 0 for some before. A directional light has all before it.
int find_light_side(CountBox p_box, vec3 p_point) {
	const vec2 across = vec2(dot(p_box.view.axis_x.xyz, p_point), dot(p_box.view.axis_y.xyz, p_point));
	const float middle = dot(across, p_box.center) + dot(p_box.view.axis_z.xyz, p_point);
	const float reach = dot(abs(across), p_box.half_size);
	return p_box.is_directional || middle > reach ? 1 : (middle < -reach ? -1 : 0);
}

// What is known of an edge for the receivers of a box: a sum of these, and its weight where all of them see the
// same. Lists have an edge and what is known of it in one word.
const uint COUNT_KNOWS_WEIGHT = 1u;
const uint COUNT_WEIGHT_SHIFT = 1u;
const int COUNT_WEIGHT_BIAS = 2;
const uint COUNT_KNOWN_SHIFT = 26u;
const uint COUNT_EDGE_MASK = (1u << COUNT_KNOWN_SHIFT) - 1u;
const uint COUNT_ADDS_NOTHING = COUNT_KNOWS_WEIGHT | uint(COUNT_WEIGHT_BIAS) << COUNT_WEIGHT_SHIFT;

/// COUNT_KNOWS_WEIGHT and the weight, or 0. p_plane1: anything where there is no second face.
uint find_known_weight(CountBox p_box, CountEdgeKind p_kind, vec4 p_plane0, vec4 p_plane1) {
	const int side0 = find_count_side(p_box, p_plane0);
	const int side1 = find_count_side(p_box, p_kind.is_inconsistent ? -p_plane1 : p_plane1);
	const bool is_known = side0 != 0 && (side1 != 0 || !p_kind.has_face1);
	const int weight = count_sum_weights(side0 > 0, side1 > 0, p_kind);
	return is_known ? COUNT_KNOWS_WEIGHT | uint(weight + COUNT_WEIGHT_BIAS) << COUNT_WEIGHT_SHIFT : 0u;
}

/// The weight in what is known.
int get_known_weight(uint p_known) {
	return int(p_known >> COUNT_WEIGHT_SHIFT & 7u) - COUNT_WEIGHT_BIAS;
}

#endif
