#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/compute_extensions_inc.glsl"
#include "shadow_edge_count/resolve_leaf_inc.glsl"

// Writes the mask of leaves whose receivers are all dark.
layout(set = 0, binding = COUNT_BINDING_OUTPUT, r16f) uniform writeonly image2D mask_image;

void main() {
	load_count_constants();
	bool is_valid;
	const CountLeaf leaf = leaves[find_group_leaf(is_valid)];
	const uint rank = gl_LocalInvocationIndex;
	if (is_valid && rank < count_leaf_pixels(leaf)) {
		imageStore(mask_image, find_image_pixel(leaf, find_set_bit(leaf.pixels_flags.xy, rank)), vec4(0.0));
	}
}
