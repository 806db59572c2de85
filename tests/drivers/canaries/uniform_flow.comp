#version 460
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_vote : require
// The counterpart of the other files: subgroup operations behind, but not in, divergent flow, and in branches and loops that
// all invocations of a subgroup take together.
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) buffer Values { uint values[]; };
layout(push_constant) uniform Push { uint count; } push;

void main() {
	const uint index = gl_GlobalInvocationID.x;
	uint value = values[index];
	if ((value & 1u) != 0u) {
		value *= values[value % 64u];
	}
	for (uint i = 0u; i < push.count; ++i) {
		value += subgroupMax(value);
	}
	if (subgroupAny(value == 3u)) {
		value = subgroupAdd(value);
	}
	values[index] = value;
}
