#version 460
// For the tests of the device: counts fragments without any target. The test sets color.x to 1.
layout(location = 0) in vec4 color;
layout(std430, set = 0, binding = 0) buffer Count { uint fragment_count; };

void main() {
	atomicAdd(fragment_count, uint(color.x));
}
