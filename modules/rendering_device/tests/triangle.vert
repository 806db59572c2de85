#version 460
// For the tests of the device: positions are in clip space.
layout(location = 0) in vec3 position;
layout(location = 0) out vec4 color;
layout(push_constant) uniform Push { vec4 color; } push;

void main() {
	color = push.color;
	gl_Position = vec4(position, 1.0);
}
