#version 460
// Not to be reported: the compiler itself adds subgroup operations to an atomic operation in divergent flow.
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) buffer Values { uint values[]; };

void main() {
	const uint index = gl_GlobalInvocationID.x;
	if (values[index + 1u] > 7u) {
		values[atomicAdd(values[0], 1u)] = index;
	}
}
