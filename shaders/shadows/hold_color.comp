#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "shadows/hold_inc.glsl"

// For an array with colours, into which a mask with one channel is copied as grey.
layout(set = 0, binding = HOLD_BINDING_RESULT, rgba16f) uniform writeonly image2DArray result_image;

void main() {
	const ivec2 size_px = textureSize(mask_texture, 0);
	const ivec2 pixel = find_lit_pixel(uvec2(size_px));
	if (any(greaterThanEqual(pixel, size_px))) {
		return;
	}
	const vec3 visibility = load_visibility(pixel);
	imageStore(result_image, ivec3(pixel, push.layer), vec4(visibility, 1.0));
}
