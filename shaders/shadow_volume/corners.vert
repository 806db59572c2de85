#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_volume/volume_inc.glsl"

// A volume whose triangles the CPU has listed.
layout(location = 0) in vec4 in_corner_node; // w: 1 at the vertex, 0 where its ray ends

void main() {
	gl_Position = volume_position_clip(in_corner_node.xyz, in_corner_node.w == 0.0);
}
