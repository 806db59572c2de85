#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "common/map_compare_inc.glsl"
#include "common/map_resolve_inc.glsl"
#include "shadow_template/shadow_template_shared.h"

// Compares the receiver with one texel of the light's depth map. Replace it with your own technique.
layout(set = 0, binding = DEPTH_MAP_BINDING_MAP) uniform texture2DArray map_texture;
layout(set = 0, binding = DEPTH_MAP_BINDING_MASK, r16f) uniform writeonly image2D mask_image;
layout(push_constant) uniform Push {
	ShadowTemplatePush push;
};

float find_visibility(ivec2 p_pixel) {
	if (!is_receiver_pixel(p_pixel)) {
		return 0.0;
	}
	uint view;
	const MapPoint point = load_map_point(p_pixel, view);
	if (is_trivially_lit(point, view, /*p_empty_views=*/0u)) {
		return 1.0;
	}
	return mix(1.0, lookup_hard(map_texture, light_views.views[view], point), push.strength);
}

void main() {
	const ivec2 pixel = find_pixel();
	if (is_in_image(pixel)) {
		imageStore(mask_image, pixel, vec4(find_visibility(pixel)));
	}
}
