#version 460
#extension GL_KHR_shader_subgroup_arithmetic : require
// A canary: a subgroup operation in a loop that invocations leave at different times.
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) buffer Values { uint values[]; };

void main() {
	const uint index = gl_GlobalInvocationID.x;
	uint value = values[index];
	uint sum = 0u;
	while (value > 1u) {
		value >>= 1;
		sum += subgroupMax(value) + values[sum % 64u];
	}
	values[index] = sum;
}
