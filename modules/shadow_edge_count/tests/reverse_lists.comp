#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/shadow_edge_count_shared.h"

// Reverses each of a leaf's lists: of silhouettes, of local faces and of entries. One invocation per leaf.
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Results {
	CountLeafResult results[];
};
layout(std430, set = 0, binding = 1) buffer Lists {
	uint lists[];
};
layout(std430, set = 0, binding = 2) readonly buffer Counts {
	uint counts[]; // EDGE_COUNT_COUNT_*
};
layout(push_constant) uniform Push {
	uint leaf_capacity;
};

void reverse(uint p_first, uint p_count) {
	for (uint i = 0u; i < p_count / 2u; ++i) {
		const uint a = p_first + i;
		const uint b = p_first + p_count - 1u - i;
		const uint word = lists[a];
		lists[a] = lists[b];
		lists[b] = word;
	}
}

void main() {
	const uint leaf = gl_GlobalInvocationID.x;
	if (leaf < min(counts[EDGE_COUNT_COUNT_ALL], leaf_capacity)) {
		const CountLeafResult result = results[leaf];
		reverse(result.first_word, result.silhouette_count);
		reverse(result.first_word + result.silhouette_count, result.face_count);
		reverse(result.first_word + result.silhouette_count + result.face_count, result.edge_count);
	}
}
