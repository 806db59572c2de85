// The entry point of resolve_unfinished.comp and resolve_unfinished_fine.comp: one round of counting edges for subgroups
// of receivers that ran out of iterations (see EDGE_COUNT_MAX_ITERATIONS). A work group is one such subgroup. It starts
// again, continues where the previous round stopped, and writes the mask when all edges are counted. Its slot in the
// next round is then that of a subgroup that waits. Edge lists are not used, as in leaves without lists.
#ifndef COUNT_ROUNDS_INC_GLSL
#define COUNT_ROUNDS_INC_GLSL

#include "shadow_edge_count/count_output_inc.glsl"
#include "shadow_edge_count/count_unfinished_inc.glsl"

layout(std430, set = 0, binding = COUNT_BINDING_UNFINISHED_STATES) buffer States {
	uint states[]; // per slot, word (EDGE_COUNT_STATE_WORDS) and invocation
};
/// The slots of a round: slot, and its item.
layout(std430, set = 0, binding = COUNT_BINDING_ROUND) readonly buffer Round {
	uvec2 round_slots[];
};
layout(std430, set = 0, binding = COUNT_BINDING_NEXT_ROUND) writeonly buffer NextRound {
	uvec2 next_round_slots[];
};

uint find_state_index(uint p_slot, uint p_word) {
	const uint slot = min(p_slot, light.unfinished_slot_count - 1u);
	return (slot * uint(EDGE_COUNT_STATE_WORDS(COUNT_SAMPLE_SET_COUNT / LANES_PER_RECEIVER)) + p_word) * SUBGROUP_SIZE +
			gl_SubgroupInvocationID;
}

uint load_state(uint p_slot, uint p_word) {
	return states[find_state_index(p_slot, p_word)];
}

void save_state(uint p_slot, uint p_word, uint p_value) {
	states[find_state_index(p_slot, p_word)] = p_value;
}

uvec2 load_state_pair(uint p_slot, uint p_word) {
	return uvec2(load_state(p_slot, p_word), load_state(p_slot, p_word + 1u));
}

void save_state_pair(uint p_slot, uint p_word, uvec2 p_value) {
	save_state(p_slot, p_word, p_value.x);
	save_state(p_slot, p_word + 1u, p_value.y);
}

const uint FIRST_COUNTER_WORD = 5u;
const uint COUNTER_WORDS = 18u;

PointCounters load_counters(uint p_slot, uint p_set) {
	const uint first = FIRST_COUNTER_WORD + p_set * COUNTER_WORDS;
	return PointCounters(load_state_pair(p_slot, first), load_state_pair(p_slot, first + 2u),
			load_state_pair(p_slot, first + 4u), load_state_pair(p_slot, first + 6u),
			load_state_pair(p_slot, first + 8u), load_state_pair(p_slot, first + 10u),
			load_state_pair(p_slot, first + 12u), load_state_pair(p_slot, first + 14u),
			load_state_pair(p_slot, first + 16u));
}

void save_counters(uint p_slot, uint p_set, PointCounters p_counters) {
	const uint first = FIRST_COUNTER_WORD + p_set * COUNTER_WORDS;
	save_state_pair(p_slot, first, p_counters.bit0);
	save_state_pair(p_slot, first + 2u, p_counters.bit1);
	save_state_pair(p_slot, first + 4u, p_counters.bit2);
	save_state_pair(p_slot, first + 6u, p_counters.bit3);
	save_state_pair(p_slot, first + 8u, p_counters.bit4);
	save_state_pair(p_slot, first + 10u, p_counters.bit5);
	save_state_pair(p_slot, first + 12u, p_counters.bit6);
	save_state_pair(p_slot, first + 14u, p_counters.bit7);
	save_state_pair(p_slot, first + 16u, p_counters.bit8);
}

CountState load_count_state(uint p_slot) {
	CountState state;
	state.solid_count = int(load_state(p_slot, 2u));
	state.area = int(load_state(p_slot, 3u));
	state.surplus = int(load_state(p_slot, 4u));
	state.counters0 = load_counters(p_slot, 0u);
#if COUNT_SAMPLE_SET_COUNT == 4
	state.counters1 = state.counters2 = state.counters3 = make_point_counters();
	if (IS_CPU) {
		state.counters1 = load_counters(p_slot, 1u);
		state.counters2 = load_counters(p_slot, 2u);
		state.counters3 = load_counters(p_slot, 3u);
	}
#endif
	return state;
}

void save_count_state(uint p_slot, CountState p_state, CountProgress p_progress) {
	save_state(p_slot, 0u, p_progress.waits ? 1u : 0u);
	save_state(p_slot, 1u, p_progress.next);
	save_state(p_slot, 2u, uint(p_state.solid_count));
	save_state(p_slot, 3u, uint(p_state.area));
	save_state(p_slot, 4u, uint(p_state.surplus));
	save_counters(p_slot, 0u, p_state.counters0);
#if COUNT_SAMPLE_SET_COUNT == 4
	if (IS_CPU) {
		save_counters(p_slot, 1u, p_state.counters1);
		save_counters(p_slot, 2u, p_state.counters2);
		save_counters(p_slot, 3u, p_state.counters3);
	}
#endif
}

/// Capacity of unfinished_items: all subgroups of all leaves. (Godot does not know the length of an array.)
uint find_max_item_count() {
	return light.leaf_capacity *
			(uint(EDGE_COUNT_BLOCK_PX * EDGE_COUNT_BLOCK_PX) * LANES_PER_RECEIVER / SUBGROUP_SIZE);
}

/// The next subgroup that waits for a slot, with EDGE_COUNT_UNFINISHED_IS_NEW. r_is_any: there was one. Called where all
/// invocations are active.
uint take_item(bool p_takes, out bool r_is_any) {
	uint index = 0u;
	const bool is_elected = subgroupElect();
	if (p_takes && is_elected) {
		index = light.unfinished_slot_count + atomicAdd(unfinished_counts[EDGE_COUNT_UNFINISHED_TAKEN], 1u);
	}
	index = subgroupBroadcastFirst(index);
	r_is_any = p_takes &&
			index < min(unfinished_counts[EDGE_COUNT_UNFINISHED_ADDED], find_max_item_count());
	return (r_is_any ? unfinished_items[index] : 0u) | EDGE_COUNT_UNFINISHED_IS_NEW;
}

/// Counts edges of a slot's subgroup. Returns true if edges remain.
bool count_slot(uint p_slot, uint p_item) {
	const bool is_new = (p_item & EDGE_COUNT_UNFINISHED_IS_NEW) != 0u;
	const uint item = p_item & ~EDGE_COUNT_UNFINISHED_IS_NEW;
	const uint subgroup = item & (1u << EDGE_COUNT_SUBGROUP_BITS) - 1u;
	const CountSubject subject = load_ranked_subject(limit_leaf(item >> EDGE_COUNT_SUBGROUP_BITS),
			(subgroup * SUBGROUP_SIZE + gl_SubgroupInvocationID) / LANES_PER_RECEIVER, true);
	CountState state = start_count(subject, find_solids(subject), is_new);
	CountProgress progress = start_progress(subject);
	if (!is_new) {
		state = load_count_state(p_slot);
		// All invocations saved the same next edge. Broadcast, so that the compiler knows that loops over it are uniform.
		progress = CountProgress(load_state(p_slot, 0u) != 0u, subgroupBroadcastFirst(load_state(p_slot, 1u)));
	}
	uint edge_count = 0u;
	count_edges(subject, state, progress, edge_count);
	const bool is_unfinished = subgroup_any(progress.waits);
	if (is_unfinished) {
		save_count_state(p_slot, state, progress);
	}
	const CountPixel pixel = make_count_pixel(subject, state, progress, edge_count);
	if (!is_unfinished && pixel.is_receiver) {
		imageStore(mask_image, pixel.pixel, vec4(pixel.visibility));
	}
	return is_unfinished;
}

void main() {
	load_count_constants();
	const bool is_first = push.round == 0u;
	const bool is_last = push.round + 1u == light.unfinished_round_count;
	iteration_limit = is_last ? NO_ITERATION_LIMIT : uint(EDGE_COUNT_MAX_ITERATIONS);
	const uint group = gl_WorkGroupID.x;
	const uvec2 slot = is_first ? uvec2(group, unfinished_items[group] | EDGE_COUNT_UNFINISHED_IS_NEW)
								: round_slots[is_first ? 0u : group];
	uint item = slot.y;
	bool is_next;
	do {
		const bool is_unfinished = count_slot(slot.x, item) && !is_last;
		const uint taken = take_item(!is_unfinished, is_next);
		item = is_unfinished ? item & ~EDGE_COUNT_UNFINISHED_IS_NEW : taken;
		is_next = is_next || is_unfinished;
	} while (is_last && is_next);
	const bool is_elected = subgroupElect();
	if (is_next && is_elected) {
		next_round_slots[extend_next_dispatch()] = uvec2(slot.x, item);
	}
	note_fault(is_last && is_next, EDGE_COUNT_FAULT_LOOP);
	report_subgroup_status();
}

#endif
