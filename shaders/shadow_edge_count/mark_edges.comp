#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/caster_edge_inc.glsl"

// Marks the edges of one caster that receivers may have to count: one invocation makes one word of 32
// edges, one work group counts those of its block.
layout(local_size_x = EDGE_COUNT_WORDS_PER_BLOCK) in;
layout(std430, set = 0, binding = FIND_BINDING_WORDS) writeonly buffer Words {
	uint words[];
};
layout(std430, set = 0, binding = FIND_BINDING_BLOCKS) writeonly buffer Blocks {
	uint block_counts[];
};

shared uint block_count;

void main() {
	if (gl_LocalInvocationID.x == 0u) {
		block_count = 0u;
	}
	barrier();
	const uint word_index = gl_GlobalInvocationID.x;
	const uint first = word_index * uint(EDGE_COUNT_EDGES_PER_WORD);
	if (first < push.edge_count) {
		uint word = 0u;
		const uint count = min(uint(EDGE_COUNT_EDGES_PER_WORD), push.edge_count - first);
		for (uint i = 0u; i < count; ++i) {
			CountEdgeRecord record;
			word |= make_caster_record(first + i, record) ? 1u << i : 0u;
		}
		words[push.first_word + word_index] = word;
		atomicAdd(block_count, uint(bitCount(word)));
	}
	barrier();
	if (gl_LocalInvocationID.x == 0u) {
		block_counts[push.first_block + gl_WorkGroupID.x] = block_count;
	}
}
