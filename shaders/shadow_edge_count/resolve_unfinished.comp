#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/compute_extensions_inc.glsl"
#include "shadow_edge_count/count_output_inc.glsl"
#include "shadow_edge_count/count_unfinished_inc.glsl"

// One round of counting edges for subgroups of receivers that ran out of iterations (see EDGE_COUNT_MAX_ITERATIONS). A work
// group is one such subgroup. It starts again, continues where the previous round stopped, and writes the mask when all
// edges are counted. Its slot in the next round is then that of a subgroup that waits. Edge lists are not used, as in
// leaves without lists.

/// What an invocation counted of one sample set, and what its sets have in common. EDGE_COUNT_STATE_WORDS words.
struct SavedCount {
	uint next; // see find_first_choice
	int area; // of CountState, as the following
	int surplus;
	PointCounters counters;
};
layout(std430, set = 0, binding = COUNT_BINDING_UNFINISHED_STATES) buffer States {
	SavedCount states[]; // per slot, sample set of an invocation, and invocation
};
/// The slots of a round: slot, and its item.
layout(std430, set = 0, binding = COUNT_BINDING_ROUND) readonly buffer Round {
	uvec2 round_slots[];
};
layout(std430, set = 0, binding = COUNT_BINDING_NEXT_ROUND) writeonly buffer NextRound {
	uvec2 next_round_slots[];
};

uint find_state_index(uint p_slot, uint p_set) {
	const uint slot = min(p_slot, light.unfinished_slot_count - 1u);
	return (slot * SETS_PER_LANE + p_set) * SUBGROUP_SIZE + gl_SubgroupInvocationID;
}

void load_count_state(uint p_slot, inout uint r_next, inout CountState r_state) {
	const SavedCount saved = states[find_state_index(p_slot, 0u)];
	// All invocations saved the same next edge. Broadcast, so that the compiler knows that loops over it are uniform.
	r_next = subgroupBroadcastFirst(saved.next);
	r_state.area = saved.area;
	r_state.surplus = saved.surplus;
	r_state.counters0 = saved.counters;
	if (SETS_PER_LANE == 4u) {
		r_state.counters1 = states[find_state_index(p_slot, 1u)].counters;
		r_state.counters2 = states[find_state_index(p_slot, 2u)].counters;
		r_state.counters3 = states[find_state_index(p_slot, 3u)].counters;
	}
}

void save_count_state(uint p_slot, uint p_next, CountState p_state) {
	states[find_state_index(p_slot, 0u)] = SavedCount(p_next, p_state.area, p_state.surplus, p_state.counters0);
	if (SETS_PER_LANE == 4u) {
		states[find_state_index(p_slot, 1u)].counters = p_state.counters1;
		states[find_state_index(p_slot, 2u)].counters = p_state.counters2;
		states[find_state_index(p_slot, 3u)].counters = p_state.counters3;
	}
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
	// All subgroups of all leaves. (Godot does not know the length of an array.)
	const uint capacity = light.leaf_capacity *
			(uint(EDGE_COUNT_BLOCK_PX * EDGE_COUNT_BLOCK_PX) * LANES_PER_RECEIVER / SUBGROUP_SIZE);
	r_is_any = p_takes && index < min(unfinished_counts[EDGE_COUNT_UNFINISHED_ADDED], capacity);
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
	uint next = find_first_choice();
	if (!is_new) {
		load_count_state(p_slot, next, state);
	}
	if (count_edges(subject, next, state)) {
		save_count_state(p_slot, next, state);
		return true;
	}
	const float visibility = find_visibility(state);
	if (subject.is_receiver) {
		imageStore(mask_image, subject.pixel, vec4(visibility));
	}
	return false;
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
