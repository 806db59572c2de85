#version 460

// Overwrites a buffer with one value, or every second word with its item's index, counted from 1: as nodes of lists (see
// EDGE_COUNT_NODE_CELLS_SHIFT) these are their own successors. One invocation per word or item.
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) buffer Words {
	uint words[];
};
layout(push_constant) uniform Push {
	uint value;
	uint makes_cycles;
	uint word_count;
};

void main() {
	const uint index = gl_GlobalInvocationID.x;
	const uint word = makes_cycles != 0u ? 2u * index + 1u : index;
	if (word < word_count) {
		words[word] = makes_cycles != 0u ? index + 1u : value;
	}
}
