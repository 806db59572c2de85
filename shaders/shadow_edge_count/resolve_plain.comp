#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/count_block_parts_inc.glsl"
#include "shadow_edge_count/count_lists_inc.glsl"

// Resolves blocks without edges: a receiver is lit if it sees the light's centre, else dark.
layout(set = 0, binding = COUNT_BINDING_OUTPUT, r16f) uniform writeonly image2D mask_image;

void main() {
	load_count_constants();
	const uint block = find_block();
	const uint parts = load_parts(block);
	const BlockPixel block_pixel = load_block_pixel(block, parts, gl_LocalInvocationIndex);
	const ivec2 pixel = ivec2(find_block_corner(block) + find_pixel_in_block(block_pixel.index));
	if (!is_in_image(pixel)) {
		return;
	}
	float visibility = 0.0;
	if (is_receiver_pixel(pixel)) {
		const CountPoint point = load_count_point(pixel);
		const bool is_counted = may_count_at(point);
		const uint part = (parts & EDGE_COUNT_IS_SORTED) != 0u ? block_pixel.sorted_part : point.view;
		const CountReceiver receiver =
				make_count_receiver(light, point.position, is_counted ? load_part_distance(block, parts, part) : 0.0);
		visibility = !is_counted || count_solids(light, VIEW_COUNT == 1u ? 0u : point.view, point.warped.xy, receiver) == 0
				? 1.0
				: 0.0;
	}
	imageStore(mask_image, pixel, vec4(visibility));
	report_faults(count_faults, count_faults != 0u);
}
