// The queue of subgroups that ran out of iterations, see EDGE_COUNT_MAX_ITERATIONS.
#ifndef COUNT_UNFINISHED_INC_GLSL
#define COUNT_UNFINISHED_INC_GLSL

layout(std430, set = 0, binding = COUNT_BINDING_UNFINISHED_COUNTS) buffer UnfinishedCounts {
	uint unfinished_counts[]; // EDGE_COUNT_UNFINISHED_*
};
layout(std430, set = 0, binding = COUNT_BINDING_UNFINISHED_ITEMS) buffer UnfinishedItems {
	uint unfinished_items[]; // see EDGE_COUNT_SUBGROUP_BITS; in arbitrary order, which does not affect the mask
};
layout(std430, set = 0, binding = COUNT_BINDING_NEXT_DISPATCH) buffer NextDispatch {
	uint next_dispatch[]; // arguments of the next round's dispatch: a work group per slot in use
};

/// Adds a slot to the next round, and returns its index there.
uint extend_next_dispatch() {
	next_dispatch[1] = 1u;
	next_dispatch[2] = 1u;
	return atomicAdd(next_dispatch[0], 1u);
}

/// Adds the subgroup if p_is_unfinished is true in some invocation.
void add_unfinished(uint p_leaf, bool p_is_unfinished) {
	const bool is_any = subgroup_any(p_is_unfinished);
	const bool is_elected = subgroupElect();
	if (is_any && is_elected) {
		const uint index = atomicAdd(unfinished_counts[EDGE_COUNT_UNFINISHED_ADDED], 1u);
		unfinished_items[index] = p_leaf << EDGE_COUNT_SUBGROUP_BITS | gl_SubgroupID;
		if (index < light.unfinished_slot_count) {
			extend_next_dispatch();
		}
	}
}

#endif
