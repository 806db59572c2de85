#version 460
#extension GL_KHR_shader_subgroup_arithmetic : require
// A canary: a subgroup operation in a branch that only some invocations take.
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) buffer Values { uint values[]; };

void main() {
	const uint index = gl_GlobalInvocationID.x;
	const uint value = values[index];
	if ((value & 1u) != 0u) {
		values[index] = subgroupAdd(value);
	}
}
