#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/renderer_shared.h"
#include "shared/frame_shared.h"

// Exposed linear radiance to sRGB-encoded bytes. The curve is the identity below 0.8 and compresses
// above it to 1, so that the penumbra's shades on screen are the mask's.
layout(local_size_x = RENDERER_GROUP_SIZE, local_size_y = RENDERER_GROUP_SIZE) in;
layout(std140, set = 0, binding = RENDERER_BINDING_FRAME) restrict readonly buffer Frame {
	FrameConstants frame;
};
layout(set = 0, binding = RENDERER_BINDING_RADIANCE) uniform texture2D radiance_texture;
layout(set = 0, binding = RENDERER_BINDING_OUTPUT, rgba8) uniform writeonly image2D output_image;

const float SHOULDER = 0.8;

float encode_srgb(float p_linear) {
	return p_linear <= 0.0031308 ? 12.92 * p_linear : 1.055 * pow(p_linear, 1.0 / 2.4) - 0.055;
}

void main() {
	const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
	if (any(greaterThanEqual(pixel, ivec2(frame.size_px)))) {
		return;
	}
	vec3 color = max(texelFetch(radiance_texture, pixel, 0).rgb, vec3(0.0));
	const float peak = max(max(color.r, color.g), color.b);
	if (peak > SHOULDER) {
		const float span = 1.0 - SHOULDER;
		const float compressed = 1.0 - span * span / (peak + span - SHOULDER);
		// Very bright colours go towards white instead of clipping to a primary.
		color = mix(color * (compressed / peak), vec3(compressed), 1.0 - 1.0 / (0.1 * (peak - compressed) + 1.0));
	}
	imageStore(output_image, pixel,
			vec4(encode_srgb(color.r), encode_srgb(color.g), encode_srgb(color.b), 1.0));
}
