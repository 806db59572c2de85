#version 460
// For test_spirv.py: a structure and an array that a branch changes.
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) buffer Values { uint values[]; };

struct Pair {
	uint first;
	uint second;
};

void main() {
	const uint index = gl_GlobalInvocationID.x;
	Pair pair = Pair(index, 3u);
	uint list[2] = uint[2](index, 4u);
	if (values[index] > 5u) {
		pair = Pair(values[index + 1u], 7u);
		list = uint[2](8u, values[index + 2u]);
	}
	const Pair pair_copy = pair;
	const uint list_copy[2] = list;
	values[index] = pair_copy.first + pair_copy.second + list_copy[0] + list_copy[1];
}
