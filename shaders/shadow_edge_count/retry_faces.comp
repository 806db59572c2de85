#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/shadow_edge_count_shared.h"

// Runs after an attempt to list a view's faces. If they did not fit, it prepares another attempt with larger texels:
// twice the width needs about a quarter of the nodes. The final attempt has one texel, and needs one node per face.
layout(local_size_x = 1) in;
layout(std140, set = 0, binding = FACE_LIST_BINDING_LIGHT) restrict readonly buffer Light {
	CountLightConstants light;
};
layout(std430, set = 0, binding = FACE_LIST_BINDING_TOTALS) buffer Totals {
	uint totals[];
};
layout(std430, set = 0, binding = FACE_LIST_BINDING_DISPATCHES) writeonly buffer Dispatches {
	uint dispatches[];
};
layout(push_constant) uniform Push {
	CountFaceListPush push;
};

const uint MAX_WORK_GROUPS = 65535u;

/// As arrange_work_groups of modules/rendering_device/work_groups.h.
void write_dispatch(uint p_first, uint p_items) {
	const uint groups = (p_items + uint(FACE_LIST_GROUP_SIZE) - 1u) / uint(FACE_LIST_GROUP_SIZE);
	const uint rows = max((groups + MAX_WORK_GROUPS - 1u) / MAX_WORK_GROUPS, 1u);
	dispatches[p_first] = (groups + rows - 1u) / rows;
	dispatches[p_first + 1u] = rows;
	dispatches[p_first + 2u] = 1u;
}

const uint MAX_LEVEL = 31u; // halves a map of any size down to one texel

void main() {
	const uint total = totals[EDGE_COUNT_TOTAL_NODES + push.view];
	const bool has_overflowed = total > light.node_capacity;
	const uvec2 size_px = light.views[push.view].map_size_px;
	if (has_overflowed) {
		uint level = totals[EDGE_COUNT_TOTAL_LEVELS + push.view];
		uint expected = total;
		do {
			++level;
			expected /= 4u;
		} while (expected > light.node_capacity);
		totals[EDGE_COUNT_TOTAL_LEVELS + push.view] = push.is_next_final != 0u ? MAX_LEVEL : level;
		totals[EDGE_COUNT_TOTAL_NODES + push.view] = 0u;
	}
	write_dispatch(FACE_LIST_DISPATCH_CLEAR, has_overflowed ? size_px.x * size_px.y : 0u);
	write_dispatch(FACE_LIST_DISPATCH_LIST, has_overflowed ? light.face_count : 0u);
}
