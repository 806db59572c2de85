#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/renderer_shared.h"
#include "shared/frame_shared.h"

// Converts exposed linear radiance to sRGB-encoded bytes. The curve is the identity up to 0.8 and compresses larger
// values to at most 1, so that the screen's luminance in a penumbra is proportional to the mask. The curve above 0.8
// has the form of the Khronos PBR Neutral tone mapper's, without its offset for small values.
layout(local_size_x = RENDERER_GROUP_SIZE, local_size_y = RENDERER_GROUP_SIZE) in;
layout(std140, set = 0, binding = RENDERER_BINDING_FRAME) restrict readonly buffer Frame {
	FrameConstants frame;
};
layout(set = 0, binding = RENDERER_BINDING_RADIANCE) uniform texture2D radiance_texture;
layout(set = 0, binding = RENDERER_BINDING_OUTPUT, rgba8) uniform writeonly image2D output_image;

layout(push_constant) uniform Push {
	ToneMapPush push;
};

const float SHOULDER = 0.8; // radiance up to which the curve is the identity

float encode_srgb(float p_linear) {
	return p_linear <= 0.0031308 ? 12.92 * p_linear : 1.055 * pow(p_linear, 1.0 / 2.4) - 0.055;
}

vec3 compress(vec3 p_radiance) {
	const vec3 color = max(p_radiance, vec3(0.0));
	const float peak = max(max(color.r, color.g), color.b);
	if (peak <= SHOULDER) {
		return color;
	}
	const float span = 1.0 - SHOULDER;
	const float compressed = 1.0 - span * span / (peak + span - SHOULDER);
	// Very bright colours go towards white instead of clipping to a primary. 0.1 sets how fast.
	return mix(color * (compressed / peak), vec3(compressed), 1.0 - 1.0 / (0.1 * (peak - compressed) + 1.0));
}

void main() {
	const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
	const int side = int(push.antialiasing);
	if (any(greaterThanEqual(pixel * side, ivec2(frame.size_px)))) {
		return;
	}
	// Averages tone-mapped colours: in a mean of radiance, one bright texel would dominate the pixel.
	vec3 color = vec3(0.0);
	for (int y = 0; y < side; ++y) {
		for (int x = 0; x < side; ++x) {
			color += compress(texelFetch(radiance_texture, pixel * side + ivec2(x, y), 0).rgb);
		}
	}
	color /= float(side * side);
	imageStore(output_image, pixel,
			vec4(encode_srgb(color.r), encode_srgb(color.g), encode_srgb(color.b), 1.0));
}
