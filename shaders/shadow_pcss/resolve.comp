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

float find_extent(LightViewConstants p_view) {
	return max(p_view.half_extent.x, p_view.half_extent.y);
}

/// The receiver's view, of the nested ones of a directional light: the finest that contains it and the texels that its
/// filter may read, else the last. Views that are not finer than the last are not drawn.
uint find_cascade(ReceiverPixel p_receiver) {
	const uint last = min(light_views.view_count, uint(MAX_LIGHT_VIEWS)) - 1u;
	uint chosen = last;
	for (uint view = 0u; view < last; ++view) {
		const LightViewConstants cascade = light_views.views[view];
		const MapPoint point = project_to_map(cascade, p_receiver.position, p_receiver.normal);
		const vec2 reach = push.light_radius * max(push.nearest_w[view] - point.w, 0.0) + 2.0 * texel_extent(cascade);
		const bool is_contained = all(lessThanEqual(abs(point.xy) + reach, cascade.half_extent));
		chosen = is_contained && find_extent(cascade) < find_extent(light_views.views[chosen]) ? view : chosen;
	}
	return chosen;
}

// Percentage-closer soft shadows, one pixel per invocation.
void main() {
	const ivec2 pixel = find_pixel();
	if (!is_in_image(pixel)) {
		return;
	}
	float visibility = 0.0;
	if (is_receiver_pixel(pixel)) {
		const ReceiverPixel receiver = load_receiver(pixel);
		const uint view = light_views.views[0].is_orthographic != 0u ? find_cascade(receiver)
																	 : find_view(light_views, receiver.position);
		const MapPoint point = project_to_map(light_views.views[view], receiver.position, receiver.normal);
		visibility = is_behind_view(light_views.views[view], point)
				? 1.0
				: pcss(map_texture, push.empty_views, light_views.views[view], point,
						  push.light_radius, push.nearest_w[view], push.tap_count,
						  interleaved_noise(pixel) * TWO_PI);
	}
	imageStore(mask_image, pixel, vec4(visibility));
}
