#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_volume/volume_inc.glsl"

// Vertices of a volume that was extruded on the CPU.
layout(location = 0) in vec4 in_corner_node; // w: 1 = the mesh vertex xyz itself, 0 = its projection to infinity

void main() {
	gl_Position = volume_position_clip(in_corner_node.xyz, in_corner_node.w == 0.0);
}
