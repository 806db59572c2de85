#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/ordered_list_inc.glsl"
#include "shadow_edge_count/caster_edge_inc.glsl"

// Writes the marked edges of one caster into the list of all, behind those of the casters before, in
// their own order, so that no sum depends on scheduling. One invocation per word. The last caster's
// pass tells how many there are.
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
layout(std430, set = 0, binding = FIND_BINDING_TOTALS) writeonly buffer Totals {
	uint totals[];
};

uint load_list_word(uint p_index) {
	return words[p_index];
}

uint load_list_block(uint p_index) {
	return block_counts[p_index];
}

void main() {
	const uint word_index = gl_GlobalInvocationID.x;
	const uint word_count = (push.edge_count + uint(EDGE_COUNT_EDGES_PER_WORD) - 1u) /
			uint(EDGE_COUNT_EDGES_PER_WORD);
	const uint first_word = gl_WorkGroupID.x * uint(EDGE_COUNT_WORDS_PER_BLOCK);
	// All blocks before, other casters' too: one list for all.
	uint place = find_list_place(uint(EDGE_COUNT_WORDS_PER_BLOCK), 0u,
			push.first_block + gl_WorkGroupID.x, push.first_word + first_word, push.first_word + min(word_index, word_count));
	if (word_index >= word_count) {
		return;
	}
	const uint first_record = view.index * push.record_capacity;
	for (uint bits = words[push.first_word + word_index]; bits != 0u; bits &= bits - 1u) {
		CountEdgeRecord record;
		make_caster_record(
				word_index * uint(EDGE_COUNT_EDGES_PER_WORD) + uint(findLSB(bits)), record);
		if (place < push.record_capacity) {
			records[first_record + place] = record;
		}
		++place;
	}
	if ((push.kind & uint(EDGE_COUNT_LAST_CASTER)) != 0u && word_index + 1u == word_count) {
		totals[uint(EDGE_COUNT_TOTAL_RECORDS) + view.index] = place; // also those without room
	}
}
