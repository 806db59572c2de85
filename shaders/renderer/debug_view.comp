#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/renderer_shared.h"
#include "shared/frame_shared.h"

// Shows one texture, stretched over the frame with the nearest texel: a range of values as black .. white, classes as
// colours, or colours as they are.
layout(local_size_x = RENDERER_GROUP_SIZE, local_size_y = RENDERER_GROUP_SIZE) in;
layout(std140, set = 0, binding = RENDERER_BINDING_FRAME) restrict readonly buffer Frame {
	FrameConstants frame;
};
layout(set = 0, binding = RENDERER_BINDING_MASK) uniform texture2D shown_texture;
layout(set = 0, binding = RENDERER_BINDING_OUTPUT, rgba8) uniform writeonly image2D output_image;
layout(push_constant) uniform Push {
	DebugViewPush push;
};

// Class 0, "none", is black. All colours but the grey are from Okabe, Ito 2008, who chose them
// to be distinguishable with every kind of colour vision.
const vec3 CLASS_COLORS[8] = vec3[8](vec3(0.0), vec3(0.90, 0.62, 0.0), vec3(0.94, 0.89, 0.26),
		vec3(0.35, 0.35, 0.35), vec3(0.80, 0.47, 0.65), vec3(0.0, 0.45, 0.70),
		vec3(0.34, 0.71, 0.91), vec3(0.0, 0.62, 0.45));

void main() {
	const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
	if (any(greaterThanEqual(pixel, ivec2(frame.size_px)))) {
		return;
	}
	const vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size_px);
	const ivec2 size = textureSize(shown_texture, 0);
	const vec4 value = texelFetch(shown_texture, ivec2(uv * vec2(size)), 0);
	const vec4 shown = (value - push.shown_range.x) / (push.shown_range.y - push.shown_range.x);
	const vec3 color = push.class_count > 0u
			? CLASS_COLORS[min(uint(value.r), push.class_count - 1u) % 8u]
			: (push.is_color != 0u ? value.rgb : clamp(shown.rrr, 0.0, 1.0));
	imageStore(output_image, pixel, vec4(color, 1.0));
}
