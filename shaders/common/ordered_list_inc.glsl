// Stream compaction that preserves the order of the items, independent of scheduling. There is one bit per item, 32 per
// word. The words of a work group form a run, whose number of set bits is stored.
#ifndef ORDERED_LIST_INC_GLSL
#define ORDERED_LIST_INC_GLSL

// Each entry point defines these for its buffers.
/// Word p_index, and the number of set bits in run p_index.
uint load_list_word(uint p_index);
uint load_list_run(uint p_index);

shared uint list_count_before;

/// List index of the first item of word p_word: the number of items that are set in runs p_first_run .. p_run - 1
/// and in words p_first_word .. p_word - 1 of the work group's own run. The whole work group must call it.
/// p_group_size: its invocations, since gl_WorkGroupSize is not yet set where this file is included.
uint find_list_index(uint p_group_size, uint p_first_run, uint p_run, uint p_first_word,
		uint p_word) {
	if (gl_LocalInvocationID.x == 0u) {
		list_count_before = 0u;
	}
	barrier();
	// The invocations together add up the counts of the preceding runs.
	uint count = 0u;
	for (uint i = p_first_run + gl_LocalInvocationID.x; i < p_run; i += p_group_size) {
		count += load_list_run(i);
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
