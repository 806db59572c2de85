// The leaf and the pixels of a work group, for passes over the leaves of one kind.
#ifndef RESOLVE_LEAF_INC_GLSL
#define RESOLVE_LEAF_INC_GLSL

#include "common/work_rows_inc.glsl"
#include "shadow_edge_count/leaf_inc.glsl"
#include "shadow_edge_count/rungs_inc.glsl"

// In one dimension: with two, llvmpipe fills subgroups only up to the size in x.
#ifdef COUNTS_EDGES
layout(local_size_x_id = EDGE_COUNT_CONSTANT_GROUP_SIZE) in;
#else
layout(local_size_x = EDGE_COUNT_BLOCK_PX * EDGE_COUNT_BLOCK_PX) in;
const uint LANES_PER_RECEIVER = 1u;
#endif
layout(constant_id = EDGE_COUNT_CONSTANT_HAS_RUNGS) const bool HAS_RUNGS = false;
layout(std430, set = 0, binding = COUNT_BINDING_KINDS) readonly buffer Kinds {
	uint kinds[]; // the leaves of each kind
};
layout(std430, set = 0, binding = COUNT_BINDING_COUNTS) readonly buffer Counts {
	uint counts[]; // EDGE_COUNT_COUNT_*
};
layout(push_constant) uniform Push {
	CountLeafPush push;
};

/// Limits an index to the leaves of the light.
uint limit_leaf(uint p_leaf) {
	return min(p_leaf, light.leaf_capacity - 1u);
}

/// Whether the pass resolves a leaf with this word in the list of its kind.
bool is_on_rung(uint p_word) {
	const uint ladder = counts[EDGE_COUNT_COUNT_LADDER];
	const uint rung = HAS_RUNGS
			? find_rung(p_word >> EDGE_COUNT_KIND_LEAF_BITS, ladder & (1u << EDGE_COUNT_FIRST_RUNG_SHIFT) - 1u,
					  ladder >> EDGE_COUNT_FIRST_RUNG_SHIFT)
			: 0u;
	return (push.rungs >> rung & 1u) != 0u;
}

/// The index of the work group's leaf. Even entries of the list come first, then odd ones (see interleave_work):
/// neighbours in the list are neighbours in the image and take about the same time, so both halves of the dispatch take
/// about the same time too. r_is_valid: false if there are fewer leaves, or if another pass resolves the leaf.
uint find_group_leaf(out bool r_is_valid) {
	const uint count = find_chunk_size(counts[push.kind], push.chunk);
	const uint group = find_work_group();
	const bool exists = group < count;
	const uint index = (exists ? interleave_work(group, count) : 0u) * light.chunk_count + push.chunk;
	const uint word = kinds[push.first_leaf + (exists ? index : 0u)];
	r_is_valid = exists && is_on_rung(word);
	return limit_leaf(word & (1u << EDGE_COUNT_KIND_LEAF_BITS) - 1u);
}

/// The position in the image of a pixel of the leaf's block. p_index: for find_pixel_in_block.
ivec2 find_image_pixel(CountLeaf p_leaf, uint p_index) {
	const uint block = floatBitsToUint(p_leaf.anchor_block.w);
	const uvec2 position = uvec2(block % light.block_count.x, block / light.block_count.x);
	return ivec2(position * uint(EDGE_COUNT_BLOCK_PX) + find_pixel_in_block(p_index));
}

#endif
