#version 460
// A canary: an array with indices that differ between invocations, too large for registers.
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) buffer Values { uint values[]; };

void main() {
	const uint index = gl_GlobalInvocationID.x;
	uint list[256];
	for (uint i = 0u; i < 256u; ++i) {
		list[(values[i] + index) % 256u] = i;
	}
	values[index] = list[values[index] % 256u] + list[(values[index] >> 8) % 256u];
}
