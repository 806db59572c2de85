#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "shadow_penumbra_fins/resolve_inc.glsl"

// Debug view: writes the case of each pixel, 1 to 6 (CASE_* in resolve_inc.glsl), or 0 for pixels that are not
// receivers.
layout(set = 0, binding = RESOLVE_BINDING_OUTPUT, r16f) uniform writeonly image2D case_image;

void main() {
	const ivec2 pixel = find_pixel();
	if (is_in_image(pixel)) {
		imageStore(case_image, pixel, vec4(float(resolve_pixel(pixel).case_number)));
	}
}
