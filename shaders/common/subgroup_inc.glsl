// Subgroup operations in which all invocations of the subgroup take part: call them only where all are active.
//
// llvmpipe of Mesa 22.3, whose subgroups have 8 invocations, shuffles in one instruction, but loops over the
// invocations in reductions, votes, ballots and broadcasts (60 to 100 cycles each). So where SUBGROUP_SIZE is 8, three
// butterfly shuffles replace them; with other sizes, which GPUs have, the built-in functions are used. Define the
// constant SUBGROUP_SIZE, the invocations per subgroup, before including this file.
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

vec2 combine_sums(vec2 p_one, vec2 p_other) {
	return p_one + p_other;
}

uint combine_sums(uint p_one, uint p_other) {
	return p_one + p_other;
}

SUBGROUP_REDUCTION(subgroup_add, vec2, combine_sums, subgroupAdd)
SUBGROUP_REDUCTION(subgroup_add, uint, combine_sums, subgroupAdd)
SUBGROUP_REDUCTION(subgroup_min, float, min, subgroupMin)
SUBGROUP_REDUCTION(subgroup_min, vec2, min, subgroupMin)
SUBGROUP_REDUCTION(subgroup_min, uint, min, subgroupMin)
SUBGROUP_REDUCTION(subgroup_max, float, max, subgroupMax)
SUBGROUP_REDUCTION(subgroup_max, vec2, max, subgroupMax)
SUBGROUP_REDUCTION(subgroup_max, uint, max, subgroupMax)
SUBGROUP_REDUCTION(subgroup_or, uint, combine_bits, subgroupOr)

/// p_value, which all invocations have, in scalar registers. The compilers of GPUs without scalar arithmetic of floats keep
/// what they compute in vector registers, unless it is broadcast. The integer operation, which changes nothing, is for the
/// LLVM of Mesa 22.3: it ends the program ("Cannot select") at the broadcast of what was a float just before.
#define SUBGROUP_UNIFORM(p_type) \
	p_type subgroup_uniform(p_type p_value) { \
		const uint zero = gl_NumWorkGroups.x >> 31; \
		return USES_BUTTERFLY ? p_value : uintBitsToFloat(subgroupBroadcastFirst(floatBitsToUint(p_value) | zero)); \
	}
SUBGROUP_UNIFORM(float)
SUBGROUP_UNIFORM(vec2)
SUBGROUP_UNIFORM(vec3)
SUBGROUP_UNIFORM(vec4)

/// Bit i is set when p_value is true in invocation i.
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

/// Makes earlier writes of the subgroup to shared memory visible to the whole subgroup. Subgroups of one work group may
/// call it a different number of times. llvmpipe of Mesa 26 treats subgroupBarrier as a barrier of the whole work
/// group, which fails in that case. So it is omitted where SUBGROUP_SIZE is that of llvmpipe, 8 on x86 and 4 on arm64:
/// llvmpipe runs a subgroup in lockstep.
void sync_subgroup_memory() {
	subgroupMemoryBarrierShared();
	if (SUBGROUP_SIZE > 8u) {
		subgroupBarrier();
	}
}

#endif
