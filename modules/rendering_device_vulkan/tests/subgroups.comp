#version 460
#extension GL_KHR_shader_subgroup_ballot : require
// For the tests of subgroup sizes: writes the built-in size and the number of active invocations.
layout(local_size_x_id = 0) in;
layout(std430, set = 0, binding = 0) writeonly buffer Target { uvec2 target[]; };

void main() {
	const uint active_count = subgroupBallotBitCount(subgroupBallot(true));
	target[gl_GlobalInvocationID.x] = uvec2(gl_SubgroupSize, active_count);
}
