#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/shadow_edge_count_shared.h"

// Casters for the layer map. Both passes over them use this one expression: equal bits, equal texels.
layout(push_constant) uniform Push {
	CountLayersPush push;
};

layout(location = 0) in vec3 in_position_node;

void main() {
	precise vec4 position_clip = push.clip_from_node * vec4(in_position_node, 1.0);
	gl_Position = position_clip;
}
