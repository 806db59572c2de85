#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/count_blocks_inc.glsl"

// Writes the mask of blocks whose receivers are all dark.
layout(set = 0, binding = COUNT_BINDING_OUTPUT, r16f) uniform writeonly image2D mask_image;

void main() {
	load_count_constants();
	const ivec2 pixel = ivec2(
			find_block_corner(find_block()) + find_pixel_in_block(gl_LocalInvocationIndex));
	if (is_in_image(pixel)) {
		imageStore(mask_image, pixel, vec4(0.0));
	}
}
