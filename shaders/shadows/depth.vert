#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/shadows_shared.h"

// Draws casters into depth maps.
layout(push_constant) uniform Push {
	DepthPush push;
};

layout(location = 0) in vec3 in_position_node;

void main() {
	// Precise, so that all passes that draw a caster with this shader, such as those of depth peeling, have depths that
	// are equal to the last bit.
	precise vec4 position_clip = push.clip_from_node * vec4(in_position_node, 1.0);
	gl_Position = position_clip;
}
