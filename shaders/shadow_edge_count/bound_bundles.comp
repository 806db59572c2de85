#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/work_rows_inc.glsl"
#include "shadow_edge_count/shadow_edge_count_shared.h"

// Computes the bounds, in space and of distances, of each group of EDGE_COUNT_BUNDLES_PER_GROUP
// bundles of a light. One invocation per group.
layout(local_size_x = 64) in;
layout(std140, set = 0, binding = FIND_BINDING_LIGHT) restrict readonly buffer Light {
	CountLightConstants light;
};
layout(std430, set = 0, binding = FIND_BINDING_TOTALS) readonly buffer Totals {
	uint totals[];
};
layout(std430, set = 0, binding = FIND_BINDING_BUNDLES) buffer Bundles {
	CountEdgeBundle bundles[];
};

void main() {
	const float FAR = 3e38;
	// For rounding of the box: fractions of its half size and of the centre's coordinates.
	const float WIDENING = 1.0001;
	const float CENTER_ROUNDING = 1e-6;
	const uint group_size = uint(EDGE_COUNT_BUNDLES_PER_GROUP);
	const uint bundle_size = uint(EDGE_COUNT_BUNDLE_SIZE);
	const uint group = find_work_item(uint(64));
	const uint bundle_count =
			min((totals[EDGE_COUNT_TOTAL_EDGES] + bundle_size - 1u) / bundle_size, light.max_bundle_count);
	if (group * group_size >= bundle_count) {
		return;
	}
	vec3 minimum = vec3(FAR);
	vec3 maximum = vec3(-FAR);
	vec2 distances = vec2(FAR, -FAR);
	for (uint i = group * group_size; i < min((group + 1u) * group_size, bundle_count); ++i) {
		const CountEdgeBundle bundle = bundles[i];
		minimum = min(minimum, bundle.center_first_distance.xyz - bundle.half_size_end_distance.xyz);
		maximum = max(maximum, bundle.center_first_distance.xyz + bundle.half_size_end_distance.xyz);
		distances.x = min(distances.x, bundle.center_first_distance.w);
		distances.y = max(distances.y, bundle.half_size_end_distance.w);
	}
	const vec3 center = 0.5 * minimum + 0.5 * maximum;
	bundles[light.max_bundle_count + group] = CountEdgeBundle(vec4(center, distances.x),
			vec4(WIDENING * max(maximum - center, center - minimum) + CENTER_ROUNDING * abs(center), distances.y));
}
