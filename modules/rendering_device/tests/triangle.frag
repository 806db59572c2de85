#version 460
// For the tests of the device: fills the triangle with one colour.
layout(location = 0) in vec4 color;
layout(location = 0) out vec4 target;

void main() {
	target = color;
}
