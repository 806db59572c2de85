// Layout of the bounds buffer: for each view, the levels of its depth pyramid, the finest first, row by row.
#ifndef BOUNDS_INC_GLSL
#define BOUNDS_INC_GLSL

#include "shadow_volume/culling_shared.h"

/// Width and height of a level.
uint bounds_size_px(uint p_level) {
	uint size_px = uint(CULLING_MAP_SIZE_PX);
	for (uint level = 0u; level < p_level; ++level) {
		size_px /= uint(CULLING_LEVEL_FACTOR);
	}
	return size_px;
}

/// Index of a texel in the bounds buffer.
uint bounds_index(uint p_view, uint p_level, uvec2 p_texel) {
	uint index = p_view * uint(CULLING_BOUNDS_PER_VIEW);
	for (uint level = 0u; level < p_level; ++level) {
		index += bounds_size_px(level) * bounds_size_px(level);
	}
	return index + p_texel.y * bounds_size_px(p_level) + p_texel.x;
}

#endif
