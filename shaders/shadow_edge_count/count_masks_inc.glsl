// 64 points of the light as two words, and 64 counters as six planes of such words: DiscMasks.
#ifndef COUNT_MASKS_INC_GLSL
#define COUNT_MASKS_INC_GLSL

#include "shadow_edge_count/shadow_edge_count_shared.h"

/// The mask of the table at that place; each entry point has the table where it reads it best.
uvec2 load_count_mask(uint p_index);

/// The bin of a direction by its diamond angle y / (|x| + |y|): 0 at -y, 1 at +x, 2 at +y, 3 at -x.
uint count_direction(vec2 p_direction) {
	const float sum = abs(p_direction.x) + abs(p_direction.y);
	const float share = sum > 0.0 ? p_direction.y / sum : 0.0;
	const float angle = p_direction.x >= 0.0 ? 1.0 + share : 3.0 - share;
	return uint(angle * float(EDGE_COUNT_DIRECTION_COUNT / 4)) % uint(EDGE_COUNT_DIRECTION_COUNT);
}

/// Points of the unit disc beyond the line that is p_offset from the centre in that direction.
uvec2 find_count_mask(vec2 p_direction, float p_offset) {
	const uint row = uint(float(EDGE_COUNT_OFFSET_COUNT) * clamp(p_offset, 0.0, 0.9999));
	return load_count_mask(
			count_direction(p_direction) * uint(EDGE_COUNT_OFFSET_COUNT) + row);
}

/// Counters of all points, with a bias so that they may fall below 0: -16..47.
struct CountPlanes {
	uvec2 planes[6];
};
const int COUNT_BIAS = 16;

CountPlanes make_count_planes() {
	CountPlanes counters;
	for (int i = 0; i < 6; ++i) {
		counters.planes[i] = uvec2((COUNT_BIAS >> i & 1) != 0 ? 0xffffffffu : 0u);
	}
	return counters;
}

/// Adds 1, or subtracts it, at the points of the mask.
void count_step(inout CountPlanes r_counters, uvec2 p_mask, bool p_is_added) {
	// Borrowing is carrying over the inverse.
	const uvec2 flip = uvec2(p_is_added ? 0u : 0xffffffffu);
	uvec2 carry = p_mask;
	for (int i = 0; i < 6; ++i) {
		const uvec2 next = (r_counters.planes[i] ^ flip) & carry;
		r_counters.planes[i] ^= carry;
		carry = next;
	}
}

int get_count(CountPlanes p_counters, uint p_sample) {
	int count = -COUNT_BIAS;
	for (int i = 0; i < 6; ++i) {
		count += int(p_counters.planes[i][p_sample >> 5] >> (p_sample & 31u) & 1u) << i;
	}
	return count;
}

#endif
