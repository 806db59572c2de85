// Stream compaction that keeps the items' order, whatever the scheduling: one bit per item, 32 per
// word. The words of a work group form a block, which stores the number of its set bits.
#ifndef ORDERED_LIST_INC_GLSL
#define ORDERED_LIST_INC_GLSL

/// Accessors of the words and the blocks' counts, which each entry point defines for its buffers.
uint load_list_word(uint p_index);
uint load_list_block(uint p_index);

shared uint list_count_before;

/// Number of items marked in blocks p_first_block .. p_block - 1 and in words p_first_word ..
/// p_word - 1, those of the work group's own block. Called by a whole work group, of p_group_size
/// invocations (gl_WorkGroupSize is 1 in what is before the entry point's layout).
uint find_list_index(uint p_group_size, uint p_first_block, uint p_block, uint p_first_word,
		uint p_word) {
	if (gl_LocalInvocationID.x == 0u) {
		list_count_before = 0u;
	}
	barrier();
	// Together the invocations add up the blocks before.
	uint count = 0u;
	for (uint i = p_first_block + gl_LocalInvocationID.x; i < p_block; i += p_group_size) {
		count += load_list_block(i);
	}
	if (count != 0u) {
		atomicAdd(list_count_before, count);
	}
	barrier();
	uint index = list_count_before;
	for (uint i = p_first_word; i < p_word; ++i) {
		index += uint(bitCount(load_list_word(i)));
	}
	return index;
}

#endif
