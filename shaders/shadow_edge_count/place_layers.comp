#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/shadow_edge_count_shared.h"

// Where the fragments of each texel stand, and how many there are, from the counts and the work groups'
// sums.
layout(local_size_x = LAYERS_GROUP_SIZE) in;
layout(set = 0, binding = LAYERS_BINDING_VIEW) uniform View {
	CountViewConstants view;
};
layout(std430, set = 0, binding = LAYERS_BINDING_COUNTS) readonly buffer Counts {
	uint counts[];
};
layout(std430, set = 0, binding = LAYERS_BINDING_SUMS) readonly buffer Sums {
	uint sums[];
};
layout(std430, set = 0, binding = LAYERS_BINDING_TEXELS) writeonly buffer Texels {
	uvec2 texels[];
};
layout(std430, set = 0, binding = LAYERS_BINDING_TOTALS) writeonly buffer Totals {
	uint totals[];
};
layout(push_constant) uniform Push {
	CountPartPush push;
};

shared uint before_group;
shared uint invocation_sums[LAYERS_GROUP_SIZE];

void main() {
	const uint own = gl_LocalInvocationID.x;
	if (own == 0u) {
		before_group = 0u;
	}
	barrier();
	uint sum = 0u;
	for (uint i = own; i < gl_WorkGroupID.x; i += uint(LAYERS_GROUP_SIZE)) {
		sum += sums[i];
	}
	atomicAdd(before_group, sum);
	const uint texel_count = uint(counts.length());
	const uint first = gl_GlobalInvocationID.x * uint(LAYERS_TEXELS_PER_INVOCATION);
	const uint end = min(first + uint(LAYERS_TEXELS_PER_INVOCATION), texel_count);
	sum = 0u;
	for (uint i = first; i < end; ++i) {
		sum += counts[i];
	}
	invocation_sums[own] = sum;
	barrier();
	uint place = before_group;
	for (uint i = 0u; i < own; ++i) {
		place += invocation_sums[i];
	}
	const uint first_fragment = view.index * push.fragment_capacity;
	for (uint i = first; i < end; ++i) {
		// What has no room is counted in the total, and then nobody reads the map.
		const uint count = counts[i];
		const uint room = push.fragment_capacity - min(place, push.fragment_capacity);
		texels[view.index * texel_count + i] = uvec2(first_fragment + place, min(count, room));
		place += count;
	}
	if (end == texel_count && first < end) {
		totals[uint(EDGE_COUNT_TOTAL_FRAGMENTS) + view.index] = place;
	}
}
