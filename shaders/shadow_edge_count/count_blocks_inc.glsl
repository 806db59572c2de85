// The blocks and pixels of a pass over the blocks of one kind. Each work group processes one block.
#ifndef COUNT_BLOCKS_INC_GLSL
#define COUNT_BLOCKS_INC_GLSL

#include "common/work_rows_inc.glsl"
#include "shadow_edge_count/count_pixels_inc.glsl"

#ifndef COUNT_GROUP_SIZE // invocations per work group, if it is not one per pixel
#define COUNT_GROUP_SIZE (EDGE_COUNT_BLOCK_PX * EDGE_COUNT_BLOCK_PX)
#endif
#ifdef COUNT_GROUP_IS_SUBGROUP
layout(local_size_x_id = EDGE_COUNT_CONSTANT_GROUP_SIZE) in;
#else
// In one dimension: with two, llvmpipe fills subgroups only up to the size in x.
layout(local_size_x = COUNT_GROUP_SIZE) in;
#endif
layout(std430, set = 0, binding = COUNT_BINDING_BLOCKS) readonly buffer Blocks {
	uint blocks[]; // a list for each kind, EDGE_COUNT_BLOCKS_*
};
layout(push_constant) uniform Push {
	CountBlockPush push;
};

/// Limits an index to the blocks of the image.
uint limit_block(uint p_block) {
	return min(p_block, light.block_count.x * light.block_count.y - 1u);
}

/// The work group's block. Even entries of the list come first, then odd ones (see
/// interleave_work): neighbours in the list are neighbours in the image and take about the same time, so both halves of
/// the dispatch take about the same time too.
uint find_block() {
	const uint index = interleave_work(gl_WorkGroupID.x, gl_NumWorkGroups.x);
	return limit_block(blocks[push.first_block + index]);
}

/// The position of the block's first pixel in the image.
uvec2 find_block_corner(uint p_block) {
	return uvec2(p_block % light.block_count.x, p_block / light.block_count.x) * uint(EDGE_COUNT_BLOCK_PX);
}

#endif
