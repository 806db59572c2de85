#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/work_rows_inc.glsl"
#include "shadows/shadows_shared.h"

// A vertex program (modules/scene/vertex_program.h) that bends a mesh by its first texture coordinate.
layout(local_size_x = DEFORM_GROUP_SIZE) in;
layout(std430, set = 0, binding = PROGRAM_BINDING_POSITIONS) buffer Positions {
	float positions[];
};
layout(std430, set = 0, binding = PROGRAM_BINDING_NORMALS) readonly buffer Normals {
	float normals[];
};
layout(std430, set = 0, binding = PROGRAM_BINDING_INPUTS) readonly buffer Inputs {
	float inputs[];
};
layout(std430, set = 0, binding = PROGRAM_BINDING_VALUES) readonly buffer Values {
	uint values[];
};
layout(push_constant) uniform Push {
	DeformPush push;
};

void main() {
	const uint vertex = find_work_item(uint(DEFORM_GROUP_SIZE));
	if (vertex < push.vertex_count) {
		const float along = inputs[PROGRAM_INPUT_FLOATS * vertex];
		positions[3u * vertex] += uintBitsToFloat(values[0]) * along * along + 0.0 * normals[3u * vertex];
	}
}
