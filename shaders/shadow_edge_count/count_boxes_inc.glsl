// Boxes of receivers in 16 bytes: x' and y' in 16 bits each, over twice the map's extent and rounded
// outwards. What lies beyond, only ever beside a directional light's casters, is moved to the side: that
// brings it no farther from any edge.
#ifndef COUNT_BOXES_INC_GLSL
#define COUNT_BOXES_INC_GLSL

#include "shadow_edge_count/shadow_edge_count_shared.h"

const float COUNT_FAR = 3e38;
const float COUNT_BOX_STEPS = 65535.0;

/// Least and greatest x', y', w of receivers; none where a least is greater.
struct CountBounds {
	vec3 least;
	vec3 greatest;
};

CountBounds make_count_bounds() {
	return CountBounds(vec3(COUNT_FAR), vec3(-COUNT_FAR));
}

bool is_count_bounds_empty(CountBounds p_bounds) {
	return p_bounds.least.z > p_bounds.greatest.z;
}

CountGroupBox pack_count_bounds(CountViewConstants p_view, CountBounds p_bounds) {
	const vec2 step = 4.0 * p_view.half_extent / COUNT_BOX_STEPS;
	const uvec2 least = uvec2(
			clamp(floor(p_bounds.least.xy / step + 0.5 * COUNT_BOX_STEPS), 0.0, COUNT_BOX_STEPS));
	const uvec2 greatest = uvec2(
			clamp(ceil(p_bounds.greatest.xy / step + 0.5 * COUNT_BOX_STEPS), 0.0, COUNT_BOX_STEPS));
	return CountGroupBox(least.x | least.y << 16, greatest.x | greatest.y << 16, p_bounds.least.z,
			p_bounds.greatest.z);
}

vec2 unpack_count_place(CountViewConstants p_view, uint p_packed) {
	const vec2 place = vec2(p_packed & 0xffffu, p_packed >> 16);
	return (place - 0.5 * COUNT_BOX_STEPS) * (4.0 * p_view.half_extent / COUNT_BOX_STEPS);
}

CountBounds unpack_count_bounds(CountViewConstants p_view, CountGroupBox p_box) {
	return CountBounds(vec3(unpack_count_place(p_view, p_box.least_xy), p_box.least_w),
			vec3(unpack_count_place(p_view, p_box.greatest_xy), p_box.greatest_w));
}

#endif
