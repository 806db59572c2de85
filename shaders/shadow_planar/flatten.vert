#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_planar/shadow_planar_shared.h"

// Projects a caster onto a plane, along the rays from the light's centre (Blinn 1988).
layout(location = 0) in vec3 in_position_node;
layout(location = 0) out float out_height_m;
layout(push_constant) uniform Push {
	FlattenPush push;
};

void main() {
	out_height_m = dot(push.plane_node.xyz, in_position_node) + push.plane_node.w;
	gl_Position = push.clip_from_node * vec4(in_position_node, 1.0);
}
