#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "common/map_resolve_inc.glsl"
#include "common/pcss_inc.glsl"
#include "shadow_pcss/shadow_pcss_shared.h"

layout(set = 0, binding = DEPTH_MAP_BINDING_MAP) uniform texture2DArray map_texture;
layout(set = 0, binding = DEPTH_MAP_BINDING_MASK, r16f) uniform writeonly image2D mask_image;
layout(push_constant) uniform Push {
	ShadowPcssPush push;
};

// Percentage-closer soft shadows, one pixel per invocation.
void main() {
	const ivec2 pixel = find_pixel();
	if (!is_in_image(pixel)) {
		return;
	}
	float visibility = 0.0;
	if (is_receiver_pixel(pixel)) {
		uint view;
		const MapPoint point = load_map_point(pixel, view);
		visibility = is_behind_view(light_views.views[view], point)
				? 1.0
				: pcss(map_texture, push.empty_views, light_views.views[view], point,
						  push.light_radius, push.nearest_w[view], push.tap_count,
						  interleaved_noise(pixel) * TWO_PI);
	}
	imageStore(mask_image, pixel, vec4(visibility));
}
