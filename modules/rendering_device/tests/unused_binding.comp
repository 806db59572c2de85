#version 460
// For the tests of reflection and of replaced shaders: like scale.comp, with a binding that is declared but not used.
layout(local_size_x = 64, local_size_x_id = 0, local_size_y = 1, local_size_z = 1) in;
layout(constant_id = 0) const uint LOCAL_SIZE = 64;
layout(constant_id = 1) const uint FACTOR = 2;
layout(std430, set = 0, binding = 0) readonly buffer Source { uint source[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Target { uint target[]; };
layout(std430, set = 0, binding = 7) buffer Unused { uint unused[]; };
layout(push_constant) uniform Push {
	uint item_count;
	uint offset;
} push;

void main() {
	const uint index = gl_GlobalInvocationID.x;
	if (index < push.item_count) {
		target[index] = source[index] * FACTOR + push.offset;
	}
}
