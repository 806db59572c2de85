#version 460
// For the tests of the device: a slow shader, whose time is proportional to the number of invocations. Software drivers
// stop an invocation after 65535 loop iterations.
layout(local_size_x = 64, local_size_y = 1, local_size_z = 1) in;
layout(std430, set = 0, binding = 0) writeonly buffer Target { float target[]; };
layout(push_constant) uniform Push {
	uint iteration_count; // up to 65535
} push;

void main() {
	float value = float(gl_LocalInvocationID.x);
	for (uint index = 0; index < push.iteration_count; ++index) {
		value = sin(value) + 1.0;
	}
	target[gl_LocalInvocationID.x] = value;
}
