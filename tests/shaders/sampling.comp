#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/sampling_inc.glsl"

// Input: sample index, sample count, rotation (rad), pixel index in rows of 256 pixels.
// Output: xy point in the unit disc, z pixel's noise.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) readonly buffer Input {
	vec4 items[];
};
layout(set = 0, binding = 1) writeonly buffer Output {
	vec4 results[];
};

void main() {
	const uint item = gl_GlobalInvocationID.x;
	if (item >= uint(items.length())) {
		return;
	}
	const vec4 value = items[item];
	const ivec2 pixel = ivec2(int(value.w) % 256, int(value.w) / 256);
	results[item] = vec4(vogel_disc(uint(value.x), uint(value.y), value.z),
			interleaved_noise(pixel), 0.0);
}
