#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_penumbra_fins/shadow_penumbra_fins_shared.h"

// Writes one caster's silhouette edges into a list, in their own order, so that the picture never
// depends on scheduling, and the arguments of the draw that follows. One invocation per word.
layout(local_size_x = FINS_WORDS_PER_BLOCK) in;
layout(std430, set = 0, binding = EDGES_BINDING_WORDS) readonly buffer Words {
	uint edge_words[];
};
layout(std430, set = 0, binding = EDGES_BINDING_BLOCKS) readonly buffer Blocks {
	uint block_counts[];
};
layout(std430, set = 0, binding = EDGES_BINDING_LIST) writeonly buffer List {
	uint edge_list[];
};
layout(std430, set = 0, binding = EDGES_BINDING_DRAWS) writeonly buffer Draws {
	FinsDraw draws[];
};
layout(push_constant) uniform Push {
	EdgesPush push;
};

shared uint edges_before_block;

void main() {
	const uint word_index = gl_GlobalInvocationID.x;
	const uint word_count = (push.edge_count + FINS_EDGES_PER_WORD - 1u) / FINS_EDGES_PER_WORD;
	// A work group is a block: together it adds up the blocks before.
	const uint block = gl_WorkGroupID.x;
	if (gl_LocalInvocationID.x == 0u) {
		edges_before_block = 0u;
	}
	barrier();
	uint count = 0u;
	for (uint i = gl_LocalInvocationID.x; i < block; i += FINS_WORDS_PER_BLOCK) {
		count += block_counts[push.first_block + i];
	}
	if (count != 0u) {
		atomicAdd(edges_before_block, count);
	}
	barrier();
	if (word_index >= word_count) {
		return;
	}
	uint place = edges_before_block;
	for (uint i = block * FINS_WORDS_PER_BLOCK; i < word_index; ++i) {
		place += uint(bitCount(edge_words[push.first_word + i]));
	}
	for (uint bits = edge_words[push.first_word + word_index]; bits != 0u; bits &= bits - 1u) {
		const uint bit = uint(findLSB(bits));
		edge_list[push.first_in_list + place] = word_index * FINS_EDGES_PER_WORD + bit;
		++place;
	}
	if (word_index + 1u == word_count) {
		draws[push.draw_index] = FinsDraw(place * push.vertices_per_edge, 1u, 0u, 0u);
	}
}
