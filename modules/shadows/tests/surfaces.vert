#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame_shared.h"

// Draws the surfaces that the camera sees, for the minimal host in surface_host.h.
layout(std140, set = 0, binding = 0) restrict readonly buffer Frame {
	FrameConstants frame;
};
layout(push_constant) uniform Push {
	mat4 camera_relative_from_node;
	vec4 material; // read by the fragment shaders
};

layout(location = 0) in vec3 in_position_node;

void main() {
	gl_Position = frame.clip_from_camera_relative * (camera_relative_from_node * vec4(in_position_node, 1.0));
}
