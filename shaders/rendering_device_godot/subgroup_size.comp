#version 460
#extension GL_KHR_shader_subgroup_basic : require

// Writes the subgroup size. Godot knows it, but its extension API has no limit for it.
layout(local_size_x = 128) in; // room for the largest subgroup: a ballot has 128 bits
layout(std430, set = 0, binding = 0) writeonly buffer Result {
	uint size;
};

void main() {
	if (gl_LocalInvocationIndex == 0u) {
		size = gl_SubgroupSize;
	}
}
