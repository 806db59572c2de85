#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "shadow_map/bindings_inc.glsl"

// Counts how many of the light's points each receiver sees, one point per pass. The last pass divides by the number of
// points. Counts up to 2^24 are exact in a float, so the result does not depend on the order.
layout(set = 0, binding = DEPTH_MAP_BINDING_MASK, r32f) uniform image2D mask_image;

void main() {
	const ivec2 pixel = find_pixel();
	if (!is_in_image(pixel)) {
		return;
	}
	float seen = 0.0;
	if (is_receiver_pixel(pixel)) {
		uint view;
		const MapPoint point = load_map_point(pixel, view);
		seen = is_trivially_lit(point, view, push.empty_views)
				? 1.0
				: lookup_hard(map_texture, light_views.views[view], point);
	}
	float count = seen + (push.point_index == 0u ? 0.0 : imageLoad(mask_image, pixel).r);
	if (push.point_index + 1u == push.point_count) {
		count /= float(push.point_count);
	}
	imageStore(mask_image, pixel, vec4(count));
}
