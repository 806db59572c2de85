#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
#include "shadow_edge_count/count_output_inc.glsl"

// Resolves leaves on EDGE_COUNT_RUNG_FEW_PIXELS: one receiver of each 2 x 2 pixels is counted, with 64 points of the
// light, and the others get a mean of the nearest counted ones.
const uint SIDE = 4u; // of the block, in quads of 2 x 2 pixels
const uint PIXELS_PER_INVOCATION = uint(EDGE_COUNT_BLOCK_PX * EDGE_COUNT_BLOCK_PX) / gl_WorkGroupSize.x;

shared vec2 counted[SIDE * SIDE]; // by row and column of the quad: visibility, or 0; 1 if it has a receiver, else 0

/// The mean of the counted receivers of the four quads around a pixel, with weights of bilinear interpolation.
float find_interpolated(uvec2 p_pixel) {
	const vec2 position = clamp(0.5 * vec2(p_pixel) - 0.25, vec2(0.0), vec2(float(SIDE - 1u)));
	const uvec2 first = min(uvec2(position), uvec2(SIDE - 2u));
	const vec2 fraction = position - vec2(first);
	vec2 sum = vec2(0.0);
	for (uint i = 0u; i < 4u; ++i) {
		const uvec2 offset = uvec2(i & 1u, i >> 1);
		const vec2 weights = mix(1.0 - fraction, fraction, vec2(offset));
		const uvec2 quad = first + offset;
		sum += weights.x * weights.y * counted[quad.y * SIDE + quad.x];
	}
	return clamp(sum.x / sum.y, 0.0, 1.0); // the pixel's own quad has a receiver
}

void main() {
	load_count_constants();
	const uint invocation = gl_LocalInvocationIndex;
	bool is_valid;
	const uint leaf = find_group_leaf(is_valid);
	if (HAS_RUNGS && !is_valid) {
		return; // another pass resolves the leaf
	}
	const uvec2 pixels = leaves[leaf].pixels_flags.xy;
	// Pixels 4 i .. 4 i + 3 are a quad, see find_pixel_in_block.
	const uint quad = invocation / LANES_PER_RECEIVER;
	const uint own_bits = (quad < 8u ? pixels.x : pixels.y) >> (4u * (quad % 8u)) & 15u;
	const uint pixel = 4u * quad + uint(max(findLSB(own_bits), 0));
	const CountSubject subject = load_subject(leaf, pixel, own_bits != 0u);
	const float visibility = count_pixel(subject, find_solids(subject)).visibility;
	const uvec2 position = find_pixel_in_block(4u * quad) / 2u;
	counted[position.y * SIDE + position.x] = own_bits != 0u ? vec2(visibility, 1.0) : vec2(0.0);
	barrier();
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		const uint index = i * gl_WorkGroupSize.x + invocation;
		if (((index < 32u ? pixels.x : pixels.y) >> (index % 32u) & 1u) != 0u) {
			imageStore(mask_image, find_image_pixel(subject.leaf, index),
					vec4(find_interpolated(find_pixel_in_block(index))));
		}
	}
}
