#version 460

// Overwrites a buffer with one value. One invocation per word.
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) buffer Words {
	uint words[];
};
layout(push_constant) uniform Push {
	uint value;
	uint word_count;
};

void main() {
	const uint index = gl_GlobalInvocationID.x;
	if (index < word_count) {
		words[index] = value;
	}
}
