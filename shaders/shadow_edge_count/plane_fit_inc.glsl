// The plane w = slope.(x', y') + constant that fits the receivers of a subgroup best (least squares). Include it after
// SUBGROUP_SIZE is defined.
#ifndef PLANE_FIT_INC_GLSL
#define PLANE_FIT_INC_GLSL

#include "common/subgroup_inc.glsl"
#include "shadow_edge_count/count_box_inc.glsl"

/// Sums over the receivers of one invocation.
struct PlaneMoments {
	vec3 squares;  // x' x', x' y', y' y', relative to the mean
	vec2 products; // x' w, y' w
};

/// The mean (x', y', w) of the subgroup's receivers. p_sum: the sum and the number of the invocation's own.
vec3 find_mean_receiver(vec4 p_sum) {
	const vec4 sum = vec4(subgroup_add(p_sum.xy), subgroup_add(p_sum.zw));
	return sum.xyz / max(sum.w, 1.0);
}

/// Adds a receiver at p_offset from the mean.
void add_to_moments(vec3 p_offset, bool p_is_selected, inout PlaneMoments r_moments) {
	r_moments.squares += p_is_selected ? p_offset.xxy * p_offset.xyy : vec3(0.0);
	r_moments.products += p_is_selected ? p_offset.xy * p_offset.z : vec2(0.0);
}

/// The slope of the plane: w per x' and y'. About 0 across a line of receivers, which determines no plane.
vec2 find_fitted_slope(PlaneMoments p_moments) {
	// Fraction of both squares that is added to them, so that receivers on a line have a unique plane.
	const float REGULARIZATION = 1e-6;
	const vec2 sums = subgroup_add(p_moments.squares.xz);
	const vec2 products = subgroup_add(p_moments.products);
	const float mixed = subgroup_add(vec2(p_moments.squares.y, 0.0)).x;
	const float size = max(sums.x + sums.y, 1e-30);
	// Divided by the size, so that no product leaves the range of floats.
	const vec2 squares = sums / size + REGULARIZATION;
	const float m = mixed / size;
	const vec2 right = products / size;
	const float determinant = squares.x * squares.y - m * m;
	return vec2(squares.y * right.x - m * right.y, squares.x * right.y - m * right.x) /
			max(determinant, 0.5 * REGULARIZATION * (squares.x + squares.y));
}

/// Joins the bounds of all invocations, which have the same slope.
CountBounds find_subgroup_bounds(CountBounds p_bounds) {
	CountBounds bounds = p_bounds;
	bounds.minimum = subgroup_min(bounds.minimum);
	bounds.maximum = subgroup_max(bounds.maximum);
	const vec2 lowest = subgroup_min(vec2(bounds.range.x, bounds.w_range.x));
	const vec2 highest = subgroup_max(vec2(bounds.range.y, bounds.w_range.y));
	bounds.range = vec2(lowest.x, highest.x);
	bounds.w_range = vec2(lowest.y, highest.y);
	return choose_flatter(bounds);
}

#endif
