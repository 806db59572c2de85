#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/count_cull_inc.glsl"

// Bounds the edges of one view's list, bundle by bundle. One invocation per bundle.
layout(local_size_x = EDGE_COUNT_WORDS_PER_BLOCK) in;
layout(set = 0, binding = FIND_BINDING_VIEW) uniform View {
	CountViewConstants view;
};
layout(std430, set = 0, binding = FIND_BINDING_LIST) readonly buffer List {
	CountEdgeRecord records[];
};
layout(std430, set = 0, binding = FIND_BINDING_TOTALS) readonly buffer Totals {
	uint totals[];
};
layout(std430, set = 0, binding = FIND_BINDING_BUNDLES) writeonly buffer Bundles {
	CountEdgeBundle bundles[];
};
layout(push_constant) uniform Push {
	CountPartPush push;
};

void main() {
	const uint size = uint(EDGE_COUNT_BUNDLE_SIZE);
	const uint bundle = gl_GlobalInvocationID.x;
	const uint capacity = push.record_capacity;
	const uint end = min(totals[uint(EDGE_COUNT_TOTAL_RECORDS) + view.index], capacity);
	if (bundle * size >= end) {
		return;
	}
	const uint first = view.index * capacity;
	CountEdgeBundle bounds = make_count_bundle(records[first + bundle * size]);
	for (uint i = bundle * size + 1u; i < min((bundle + 1u) * size, end); ++i) {
		bounds = join_count_bundles(bounds, make_count_bundle(records[first + i]));
	}
	bundles[view.index * ((capacity + size - 1u) / size) + bundle] = bounds;
}
