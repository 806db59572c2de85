#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_volume/culling_shared.h"

// Draws an occluder's triangles from the light.
layout(std430, set = 0, binding = CULLING_BINDING_POSITIONS) readonly buffer Positions {
	vec4 positions_node[];
};
layout(std430, set = 0, binding = CULLING_BINDING_TRIANGLES) readonly buffer Triangles {
	uint triangles[]; // three vertex indices per face
};
layout(push_constant) uniform Push {
	OccluderPush push;
};

void main() {
	const uint index = uint(gl_VertexIndex);
	const uint vertex = triangles[index];
	gl_Position = push.clip_from_node * vec4(positions_node[vertex].xyz, 1.0);
}
