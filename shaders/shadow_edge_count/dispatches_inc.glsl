// The indirect dispatches over leaves.
#ifndef DISPATCHES_INC_GLSL
#define DISPATCHES_INC_GLSL

#include "shadow_edge_count/shadow_edge_count_shared.h"

layout(std430, set = 0, binding = COUNT_BINDING_ARGUMENTS) buffer Arguments {
	uint arguments[]; // EDGE_COUNT_ARGUMENT_WORDS for each dispatch
};
layout(std430, set = 0, binding = COUNT_BINDING_COUNTS) buffer Counts {
	uint counts[]; // EDGE_COUNT_COUNT_*
};

/// Adds a leaf to the dispatches of its kind, and returns its index there. p_count: its word in `counts`. Each of the
/// light's chunks gets the same number of work groups, in rows, since a device may limit how many a row has.
uint extend_dispatch(uint p_dispatch, uint p_count) {
	const uint first_word = p_dispatch * uint(EDGE_COUNT_ARGUMENT_WORDS);
	const uint index = atomicAdd(counts[p_count], 1u);
	arguments[first_word] = uint(EDGE_COUNT_GROUPS_PER_ROW);
	atomicMax(arguments[first_word + 1u], index / light.chunk_count / uint(EDGE_COUNT_GROUPS_PER_ROW) + 1u);
	arguments[first_word + 2u] = 1u;
	return index;
}

#endif
