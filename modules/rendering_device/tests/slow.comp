#version 460
// For the tests of the device: takes long, in proportion to the number of invocations. Software drivers end each of
// them after 65535 rounds of its loops.
layout(local_size_x = 64, local_size_y = 1, local_size_z = 1) in;
layout(std430, set = 0, binding = 0) writeonly buffer Target { float target[]; };
layout(push_constant) uniform Push {
	uint round_count; // up to 65535
} push;

void main() {
	float value = float(gl_LocalInvocationID.x);
	for (uint index = 0; index < push.round_count; ++index) {
		value = sin(value) + 1.0;
	}
	target[gl_LocalInvocationID.x] = value;
}
