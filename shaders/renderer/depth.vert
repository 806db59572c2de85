#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame_shared.h"

layout(push_constant) uniform Push {
	DepthPush push;
};

layout(location = 0) in vec3 in_position_node;

// Every pass that draws casters from a light uses this one expression: equal bits, equal depth.
invariant gl_Position;

void main() {
	gl_Position = push.clip_from_node * vec4(in_position_node, 1.0);
}
