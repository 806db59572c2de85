#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "shadows/hold_inc.glsl"

// For an array with one channel, into which a coloured mask is copied as its luminance.
layout(set = 0, binding = HOLD_BINDING_RESULT, r16f) uniform writeonly image2DArray result_image;

void main() {
	const ivec2 size_px = textureSize(mask_texture, 0);
	const ivec2 pixel = find_lit_pixel(uvec2(size_px));
	if (any(greaterThanEqual(pixel, size_px))) {
		return;
	}
	const vec3 visibility = load_visibility(pixel);
	imageStore(result_image, ivec3(pixel, push.layer), vec4(IS_COLORED != 0u ? mask_luminance(visibility) : visibility.r));
}
