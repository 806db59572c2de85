#version 460
#extension GL_KHR_shader_subgroup_basic : require
// A canary: a barrier of the subgroup that only some invocations reach.
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) buffer Values { uint values[]; };
shared uint shared_values[64];

void main() {
	const uint index = gl_GlobalInvocationID.x;
	shared_values[gl_LocalInvocationID.x] = values[index];
	if (values[index] > 7u) {
		subgroupBarrier();
	}
	values[index] = shared_values[63u - gl_LocalInvocationID.x];
}
