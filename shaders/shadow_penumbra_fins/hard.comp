#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "shadow_penumbra_fins/bindings_inc.glsl"

// Resolves the mask when the widths of outer and inner fins are 0 (r = t = 0). Only CASE_LIT and
// CASE_UMBRA_NO_FIN of resolve_inc.glsl remain, which is a plain shadow map.
layout(set = 0, binding = RESOLVE_BINDING_OUTPUT, r16f) uniform writeonly image2D mask_image;

void main() {
	const ivec2 pixel = find_pixel();
	if (!is_in_image(pixel)) {
		return;
	}
	float visibility = 0.0;
	if (is_receiver_pixel(pixel)) {
		uint view;
		const MapPoint point = load_map_point(pixel, view);
		visibility = is_trivially_lit(point, view, push.empty_views)
				? 1.0
				: lookup_hard(layer_1_texture, light_views.views[view], point);
	}
	imageStore(mask_image, pixel, vec4(visibility));
}
