#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "shadow_penumbra_fins/resolve_inc.glsl"

// Writes the mask of fins, see resolve_inc.glsl.
layout(set = 0, binding = RESOLVE_BINDING_OUTPUT, r16f) uniform writeonly image2D mask_image;

void main() {
	const ivec2 pixel = find_pixel();
	if (is_in_image(pixel)) {
		imageStore(mask_image, pixel, vec4(clamp(resolve_pixel(pixel).visibility, 0.0, 1.0)));
	}
}
