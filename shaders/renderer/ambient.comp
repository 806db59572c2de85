#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/renderer_shared.h"
#include "shared/frame_shared.h"

// Starts a frame's radiance, times the exposure: ambient and emitted light, and the background.
layout(local_size_x = RENDERER_GROUP_SIZE, local_size_y = RENDERER_GROUP_SIZE) in;
layout(std140, set = 0, binding = RENDERER_BINDING_FRAME) restrict readonly buffer Frame {
	FrameConstants frame;
};
layout(set = 0, binding = RENDERER_BINDING_DEPTH) uniform texture2D depth_texture;
layout(set = 0, binding = RENDERER_BINDING_BASE_COLOR) uniform texture2D base_color_texture;
layout(set = 0, binding = RENDERER_BINDING_EMISSIVE) uniform texture2D emissive_texture;
layout(set = 0, binding = RENDERER_BINDING_RADIANCE,
		rgba16f) uniform writeonly image2D radiance_image;
layout(push_constant) uniform Push {
	ExposurePush push;
};

void main() {
	const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
	if (any(greaterThanEqual(pixel, ivec2(frame.size_px)))) {
		return;
	}
	vec3 radiance = push.ambient.rgb * 0.6; // background: 60 % of a white surface's
	if (texelFetch(depth_texture, pixel, 0).r > 0.0) {
		const vec4 base_color = texelFetch(base_color_texture, pixel, 0);
		radiance = push.ambient.rgb * base_color.rgb * base_color.a +
				texelFetch(emissive_texture, pixel, 0).rgb;
	}
	radiance = min(radiance * push.ambient.a, vec3(RENDERER_MAX_RADIANCE));
	imageStore(radiance_image, pixel, vec4(radiance, 1.0));
}
