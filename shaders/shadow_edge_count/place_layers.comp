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

layout(std430, set = 0, binding = LAYERS_BINDING_FRAGMENTS) writeonly buffer Fragments {
	uint fragments[];
};

shared uint before_group;
shared uint all_groups;
shared uint invocation_sums[LAYERS_GROUP_SIZE];

void main() {
	const uint own = gl_LocalInvocationID.x;
	if (own == 0u) {
		before_group = 0u;
		all_groups = 0u;
	}
	barrier();
	uint sum = 0u;
	uint all_sum = 0u;
	for (uint i = own; i < gl_NumWorkGroups.x; i += uint(LAYERS_GROUP_SIZE)) {
		sum += i < gl_WorkGroupID.x ? sums[i] : 0u;
		all_sum += sums[i];
	}
	atomicAdd(before_group, sum);
	atomicAdd(all_groups, all_sum);
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
	// Without room for all, each texel gets as many places as any.
	const bool is_short = all_groups > push.fragment_capacity;
	const uint most = push.fragment_capacity / texel_count;
	const uint first_fragment = view.index * push.fragment_capacity;
	for (uint i = first; i < end; ++i) {
		const uint count = counts[i];
		const uint first_place = first_fragment + (is_short ? i * most : place);
		texels[view.index * texel_count + i] =
				uvec2(first_place, is_short ? min(count, most) | LAYERS_ONLY_NEAREST : count);
		for (uint k = 0u; k < (is_short ? most : 0u); ++k) {
			fragments[first_place + k] = 0u;
		}
		place += count;
	}
	if (end == texel_count && first < end) {
		totals[uint(EDGE_COUNT_TOTAL_FRAGMENTS) + view.index] = place;
	}
}
