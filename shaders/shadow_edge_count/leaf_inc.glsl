// A leaf, and what list_leaves.comp found for it.
#ifndef LEAF_INC_GLSL
#define LEAF_INC_GLSL

#include "shadow_edge_count/count_box_inc.glsl"
#include "shadow_edge_count/count_pixels_inc.glsl"

#ifdef WRITES_LEAVES
layout(std430, set = 0, binding = COUNT_BINDING_LEAVES) writeonly buffer Leaves {
#else
layout(std430, set = 0, binding = COUNT_BINDING_LEAVES) readonly buffer Leaves {
#endif
	CountLeaf leaves[];
};

bool is_wide_leaf(CountLeaf p_leaf) {
	return (p_leaf.pixels_flags.z & EDGE_COUNT_LEAF_IS_WIDE) != 0u;
}

/// The number of the leaf's receivers.
uint count_leaf_pixels(CountLeaf p_leaf) {
	return uint(bitCount(p_leaf.pixels_flags.x) + bitCount(p_leaf.pixels_flags.y));
}

/// The number of leaves of a chunk of p_count leaves, see CountLeafPush.
uint find_chunk_size(uint p_count, uint p_chunk) {
	return (p_count + light.chunk_count - 1u - p_chunk) / light.chunk_count;
}

#endif
