// The parts of a block's pixels, for passes over blocks.
#ifndef COUNT_BLOCK_PARTS_INC_GLSL
#define COUNT_BLOCK_PARTS_INC_GLSL

#include "shadow_edge_count/count_blocks_inc.glsl"
#include "shadow_edge_count/count_status_inc.glsl"

layout(std430, set = 0, binding = COUNT_BINDING_BLOCK_RECEIVERS) readonly buffer BlockReceivers {
	uint block_receivers[]; // per block, EDGE_COUNT_RECEIVERS_*
};
layout(std430, set = 0, binding = COUNT_BINDING_CHAINS) readonly buffer Chains {
	uint chains[]; // per block and part, EDGE_COUNT_CHAIN_*
};
layout(std430, set = 0, binding = COUNT_BINDING_STATUS) buffer Status {
	uint status[]; // EDGE_COUNT_STATUS_*
};

/// Writes faults that note_fault noted, in the invocations with p_reports.
void report_faults(uint p_faults, bool p_reports) {
	if (p_reports) {
		atomicOr(status[EDGE_COUNT_STATUS_FAULTS], p_faults << push.kind);
	}
}

/// The block's word EDGE_COUNT_RECEIVERS_PARTS.
uint load_parts(uint p_block) {
	return block_receivers[p_block * uint(EDGE_COUNT_RECEIVERS_WORDS) + uint(EDGE_COUNT_RECEIVERS_PARTS)];
}

/// The pixel that an invocation processes, as its index for find_pixel_in_block, and the part of its receiver.
struct BlockPixel {
	uint index;
	uint sorted_part; // meaningless if the block is not sorted: then the part is the receiver's view
};

/// p_parts: see load_parts. p_invocation: 0..63.
BlockPixel load_block_pixel(uint p_block, uint p_parts, uint p_invocation) {
	const uint first = p_block * uint(EDGE_COUNT_RECEIVERS_WORDS) + uint(EDGE_COUNT_RECEIVERS_ORDER);
	const uint order = block_receivers[first + p_invocation / 4u] >> (8u * (p_invocation % 4u)) & 0xffu;
	const bool is_sorted = (p_parts & EDGE_COUNT_IS_SORTED) != 0u;
	return BlockPixel(is_sorted ? order & EDGE_COUNT_ORDER_PIXEL_MASK : p_invocation,
			order >> EDGE_COUNT_ORDER_PART_SHIFT);
}

/// Index in `chains` of the first word of a part.
uint find_chain(uint p_block, uint p_part) {
	return (p_block * PART_COUNT + p_part) * uint(EDGE_COUNT_CHAIN_WORDS);
}

/// See EDGE_COUNT_CHAIN_DISTANCE. 0, which selects fine levels of detail, if rounding puts a receiver at the border of
/// two views into a part that has none. p_parts: see load_parts.
float load_part_distance(uint p_block, uint p_parts, uint p_part) {
	const bool has_receivers = (p_parts >> p_part & 1u) != 0u;
	const uint word = find_chain(p_block, has_receivers ? p_part : 0u) + uint(EDGE_COUNT_CHAIN_DISTANCE);
	return has_receivers ? uintBitsToFloat(chains[word]) : 0.0;
}

#endif
