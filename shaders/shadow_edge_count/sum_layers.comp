#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/shadow_edge_count_shared.h"

// How many fragments the texels of each work group have in sum.
layout(local_size_x = LAYERS_GROUP_SIZE) in;
layout(std430, set = 0, binding = LAYERS_BINDING_COUNTS) readonly buffer Counts {
	uint counts[];
};
layout(std430, set = 0, binding = LAYERS_BINDING_SUMS) writeonly buffer Sums {
	uint sums[];
};

shared uint group_sum;

void main() {
	if (gl_LocalInvocationID.x == 0u) {
		group_sum = 0u;
	}
	barrier();
	const uint first = gl_GlobalInvocationID.x * uint(LAYERS_TEXELS_PER_INVOCATION);
	const uint end = min(first + uint(LAYERS_TEXELS_PER_INVOCATION), uint(counts.length()));
	uint sum = 0u;
	for (uint i = first; i < end; ++i) {
		sum += counts[i];
	}
	atomicAdd(group_sum, sum);
	barrier();
	if (gl_LocalInvocationID.x == 0u) {
		sums[gl_WorkGroupID.x] = group_sum;
	}
}
