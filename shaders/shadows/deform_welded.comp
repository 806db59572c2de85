#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/work_rows_inc.glsl"
#include "shadows/shadows_shared.h"

// Copies the positions of a deformed mesh to its welded vertices, each from one of the vertices that it replaces.
layout(local_size_x = DEFORM_GROUP_SIZE) in;
layout(std430, set = 0, binding = MOVE_BINDING_POSITIONS) readonly buffer Positions {
	float positions[];
};
layout(std430, set = 0, binding = MOVE_BINDING_SOURCES) readonly buffer Sources {
	uint vertices[];
};
layout(std430, set = 0, binding = MOVE_BINDING_RESULT) writeonly buffer Result {
	vec4 welded_positions[];
};
layout(push_constant) uniform Push {
	DeformPush push;
};

void main() {
	const uint welded = find_work_item(uint(DEFORM_GROUP_SIZE));
	if (welded >= push.vertex_count) {
		return;
	}
	const uint first = 3u * vertices[welded];
	welded_positions[welded] = vec4(positions[first], positions[first + 1u], positions[first + 2u], 1.0);
}
