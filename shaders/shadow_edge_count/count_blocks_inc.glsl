// The pixels of a pass over blocks of one kind: a work group deals with one group of a block's pixels.
#ifndef COUNT_BLOCKS_INC_GLSL
#define COUNT_BLOCKS_INC_GLSL

#include "shadow_edge_count/count_pixels_inc.glsl"

layout(local_size_x = MAP_RESOLVE_GROUP_SIZE, local_size_y = MAP_RESOLVE_GROUP_SIZE) in;
layout(set = 0, binding = COUNT_BINDING_BLOCKS) uniform utextureBuffer blocks_buffer;
layout(push_constant) uniform Push {
	CountBlockPush push;
};

uint find_block() {
	return texelFetch(blocks_buffer, int(push.first_block + gl_WorkGroupID.x)).r;
}

/// The first pixel of the work group.
uvec2 find_block_group(uint p_block) {
	const uvec2 block = uvec2(p_block % light.block_count.x, p_block / light.block_count.x);
	const uint side = uint(EDGE_COUNT_GROUPS_PER_BLOCK_SIDE);
	const uvec2 group = block * side + uvec2(gl_WorkGroupID.y % side, gl_WorkGroupID.y / side);
	return group * uint(MAP_RESOLVE_GROUP_SIZE);
}

#endif
