#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/caster_edge_inc.glsl"

// Writes the marked edges of one caster into the list of all, behind those of the casters before, in
// their own order, so that no sum depends on scheduling. One invocation per word.
layout(local_size_x = EDGE_COUNT_WORDS_PER_BLOCK) in;
layout(std430, set = 0, binding = FIND_BINDING_WORDS) readonly buffer Words {
	uint words[];
};
layout(std430, set = 0, binding = FIND_BINDING_BLOCKS) readonly buffer Blocks {
	uint block_counts[];
};
layout(std430, set = 0, binding = FIND_BINDING_LIST) writeonly buffer List {
	CountEdgeRecord records[];
};

shared uint edges_before_block;

void main() {
	const uint word_index = gl_GlobalInvocationID.x;
	const uint word_count = (push.edge_count + uint(EDGE_COUNT_EDGES_PER_WORD) - 1u) /
			uint(EDGE_COUNT_EDGES_PER_WORD);
	const uint block = push.first_block + gl_WorkGroupID.x;
	if (gl_LocalInvocationID.x == 0u) {
		edges_before_block = 0u;
	}
	barrier();
	// A work group is a block: together it adds up the blocks before, other casters' too.
	uint count = 0u;
	for (uint i = gl_LocalInvocationID.x; i < block; i += uint(EDGE_COUNT_WORDS_PER_BLOCK)) {
		count += block_counts[i];
	}
	if (count != 0u) {
		atomicAdd(edges_before_block, count);
	}
	barrier();
	if (word_index >= word_count) {
		return;
	}
	uint place = edges_before_block;
	for (uint i = gl_WorkGroupID.x * uint(EDGE_COUNT_WORDS_PER_BLOCK); i < word_index; ++i) {
		place += uint(bitCount(words[push.first_word + i]));
	}
	for (uint bits = words[push.first_word + word_index]; bits != 0u; bits &= bits - 1u) {
		CountEdgeRecord record;
		make_caster_record(
				word_index * uint(EDGE_COUNT_EDGES_PER_WORD) + uint(findLSB(bits)), record);
		records[place] = record;
		++place;
	}
}
