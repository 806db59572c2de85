#version 460
// One step of a chain: each word of the result is one above the word that it comes from. The next step has twice as
// many work groups.
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Source {
	uint source[];
};
layout(std430, set = 0, binding = 1) writeonly buffer Target {
	uint target[];
};
layout(std430, set = 0, binding = 2) writeonly buffer Arguments {
	uint arguments[]; // of the next step
};

void main() {
	const uint item = gl_GlobalInvocationID.x;
	target[item] = source[item / 2u] + 1u;
	if (item == 0u) {
		arguments[0] = 2u * gl_NumWorkGroups.x;
		arguments[1] = 1u;
		arguments[2] = 1u;
	}
}
