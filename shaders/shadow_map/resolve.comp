#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "shadow_map/bindings_inc.glsl"

// Compares each receiver with the depth map: hard, or percentage-closer filtered.
layout(set = 0, binding = DEPTH_MAP_BINDING_MASK, r16f) uniform writeonly image2D mask_image;
layout(constant_id = SHADOW_MAP_CONSTANT_FILTER_WIDTH) const int FILTER_WIDTH = 0; // in texels; 0 = hard

void main() {
	const ivec2 pixel = find_pixel();
	if (!is_in_image(pixel)) {
		return;
	}
	float visibility = 0.0;
	if (is_receiver_pixel(pixel)) {
		uint view;
		const MapPoint point = load_map_point(pixel, view);
		if (is_trivially_lit(point, view, push.empty_views)) {
			visibility = 1.0;
		} else if (FILTER_WIDTH == 0) {
			visibility = lookup_hard(map_texture, light_views.views[view], point);
		} else {
			visibility =
					lookup_filtered(map_texture, light_views.views[view], point, FILTER_WIDTH);
		}
	}
	imageStore(mask_image, pixel, vec4(visibility));
}
