#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/compute_extensions_inc.glsl"
#include "common/pcss_inc.glsl"
#include "shadow_edge_count/resolve_leaf_inc.glsl"

// Resolves leaves that have more edges than CountLightConstants::budget with percentage-closer soft
// shadows.
layout(set = 0, binding = COUNT_BINDING_DEPTH_MAP) uniform texture2DArray map_texture;
layout(set = 0, binding = COUNT_BINDING_OUTPUT, r16f) uniform writeonly image2D mask_image;

void main() {
	load_count_constants();
	bool is_valid;
	const CountLeaf leaf = leaves[find_group_leaf(is_valid)];
	const uint rank = gl_LocalInvocationIndex;
	if (!is_valid || rank >= count_leaf_pixels(leaf)) {
		return;
	}
	const ivec2 pixel = find_image_pixel(leaf, find_set_bit(leaf.pixels_flags.xy, rank));
	const ReceiverPixel receiver = load_receiver(pixel);
	const uint view = find_view(light_views, receiver.position);
	const MapPoint point = project_to_map(light_views.views[view], receiver.position, receiver.normal);
	const bool is_trivially_lit =
			(light.empty_views & (1u << view)) != 0u || is_behind_view(light_views.views[view], point);
	const float visibility = is_trivially_lit
			? 1.0
			: pcss(map_texture, light.empty_views, light_views.views[view], point, light.disc_radius,
					  push.nearest_w, EDGE_COUNT_FILTER_TAPS, interleaved_noise(pixel) * TWO_PI);
	imageStore(mask_image, pixel, vec4(visibility));
}
