// For compute shaders that process only the tiles of pixels that a light may reach, see modules/shadows/lit_tiles.h. Define
// LIT_TILES_BINDING as the binding of the tiles before including this file.
#ifndef LIT_TILES_INC_GLSL
#define LIT_TILES_INC_GLSL

#include "common/work_rows_inc.glsl"
#include "shared/lit_tiles_shared.h"

layout(std430, set = 0, binding = LIT_TILES_BINDING) restrict readonly buffer LitTiles {
	uint lit_tiles[];
};

/// The tile with index p_index in the list, in tiles from the top left. r_is_valid: false if there are fewer tiles.
uvec2 load_lit_tile(uint p_index, uvec2 p_image_px, out bool r_is_valid) {
	const uint count = lit_tiles[LIT_TILES_COUNT];
	r_is_valid = p_index < count;
	const uint tile = lit_tiles[uint(LIT_TILES_FIRST) + (r_is_valid ? interleave_work(p_index, count) : 0u)];
	const uint columns = (p_image_px.x + uint(LIT_TILE_PX) - 1u) / uint(LIT_TILE_PX);
	return uvec2(tile % columns, tile / columns);
}

/// The tile of a work group of TileDispatch::TILES.
uvec2 find_lit_tile(uvec2 p_image_px, out bool r_is_valid) {
	return load_lit_tile(gl_WorkGroupID.y * uint(LIT_TILES_PER_ROW) + gl_WorkGroupID.x, p_image_px, r_is_valid);
}

/// The block of 8 x 8 pixels of a work group of TileDispatch::BLOCKS, in blocks from the top left. r_is_valid: false if
/// there is none, or if it is outside the image.
uvec2 find_lit_block(uvec2 p_image_px, out bool r_is_valid) {
	const uint blocks = uint(LIT_TILE_BLOCKS);
	const uint index = gl_WorkGroupID.y * uint(LIT_TILES_PER_ROW) + gl_WorkGroupID.x / blocks;
	const uvec2 tile = load_lit_tile(index, p_image_px, r_is_valid);
	const uint part = gl_WorkGroupID.x % blocks;
	const uvec2 block = 2u * tile + uvec2(part % 2u, part / 2u);
	r_is_valid = r_is_valid && all(lessThan(8u * block, p_image_px));
	return block;
}

/// The pixel of an invocation of a work group of 8 x 8 of TileDispatch::BLOCKS; outside the image if there is none.
ivec2 find_lit_pixel(uvec2 p_image_px) {
	bool is_valid;
	const uvec2 block = find_lit_block(p_image_px, is_valid);
	return is_valid ? ivec2(8u * block + gl_LocalInvocationID.xy) : ivec2(p_image_px);
}

#endif
