#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/count_blocks_inc.glsl"

// Resolves blocks whose receivers are either all lit or all dark.
layout(set = 0, binding = COUNT_BINDING_OUTPUT, r16f) uniform writeonly image2D mask_image;

void main() {
	load_count_constants();
	const uint entry = load_block_entry();
	const ivec2 pixel = ivec2(
			find_block_corner(limit_block(entry)) + find_pixel_in_block(gl_LocalInvocationIndex));
	if (is_in_image(pixel)) {
		const bool is_lit = (entry & EDGE_COUNT_BLOCK_IS_DARK) == 0u && is_receiver_pixel(pixel);
		imageStore(mask_image, pixel, vec4(is_lit ? 1.0 : 0.0));
	}
}
