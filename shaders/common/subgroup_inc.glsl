// Operations over a whole subgroup in which all invocations take part: no branch or loop may have stopped any.
//
// llvmpipe 22.3, whose subgroups have 8 invocations, shuffles in one instruction, but loops over the invocations in
// reductions, votes, ballots and broadcasts (60 to 100 cycles each). There three shuffles in a butterfly do the same;
// other devices have instructions for them. Before it: SUBGROUP_SIZE, a constant, the invocations of a subgroup.
#ifndef SUBGROUP_INC_GLSL
#define SUBGROUP_INC_GLSL

const bool USES_BUTTERFLY = SUBGROUP_SIZE == 8u;

#define SUBGROUP_REDUCTION(p_name, p_type, p_combine, p_builtin) \
	p_type p_name(p_type p_value) { \
		p_type result = p_value; \
		if (USES_BUTTERFLY) { \
			result = p_combine(result, subgroupShuffleXor(result, 1u)); \
			result = p_combine(result, subgroupShuffleXor(result, 2u)); \
			result = p_combine(result, subgroupShuffleXor(result, 4u)); \
		} else { \
			result = p_builtin(result); \
		} \
		return result; \
	}

uint combine_bits(uint p_one, uint p_other) {
	return p_one | p_other;
}

SUBGROUP_REDUCTION(subgroup_min, float, min, subgroupMin)
SUBGROUP_REDUCTION(subgroup_min, vec2, min, subgroupMin)
SUBGROUP_REDUCTION(subgroup_min, uint, min, subgroupMin)
SUBGROUP_REDUCTION(subgroup_max, float, max, subgroupMax)
SUBGROUP_REDUCTION(subgroup_max, vec2, max, subgroupMax)
SUBGROUP_REDUCTION(subgroup_max, uint, max, subgroupMax)
SUBGROUP_REDUCTION(subgroup_or, uint, combine_bits, subgroupOr)

/// A bit for each invocation that has true.
uvec4 subgroup_ballot(bool p_value) {
	if (USES_BUTTERFLY) {
		return uvec4(subgroup_or(p_value ? 1u << gl_SubgroupInvocationID : 0u), 0u, 0u, 0u);
	}
	return subgroupBallot(p_value);
}

bool subgroup_any(bool p_value) {
	return USES_BUTTERFLY ? subgroup_or(p_value ? 1u : 0u) != 0u : subgroupAny(p_value);
}

bool subgroup_all(bool p_value) {
	return !subgroup_any(!p_value);
}

/// What the subgroup wrote to shared memory before is there for all of it. Subgroups of one work group may come here
/// unequally often: llvmpipe 26 takes the barrier for one of the whole group, and loses those that come more often. Its
/// subgroups go in step anyway.
void sync_subgroup_memory() {
	subgroupMemoryBarrierShared();
	if (!USES_BUTTERFLY) {
		subgroupBarrier();
	}
}

#endif
