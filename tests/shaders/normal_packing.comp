#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/normal_inc.glsl"

// Packs and unpacks a unit vector. Output: the unpacked vector, and the two packed 16-bit halves as numbers.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) readonly buffer Input {
	vec4 normals[];
};
layout(set = 0, binding = 1) writeonly buffer Output {
	vec4 results[]; // two per item
};

void main() {
	const uint item = gl_GlobalInvocationID.x;
	if (item >= uint(normals.length())) {
		return;
	}
	const uint packed = pack_normal(normals[item].xyz);
	results[2u * item] = vec4(unpack_normal(packed), 0.0);
	results[2u * item + 1u] = vec4(float(packed & 0xffffu), float(packed >> 16), 0.0, 0.0);
}
