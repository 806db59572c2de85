#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/renderer_shared.h"

// Draws an image into a window, which may have another size, with the nearest texel. Stored values are not converted.
layout(set = 0, binding = PRESENT_BINDING_IMAGE) uniform texture2D image;
layout(push_constant) uniform Push {
	PresentPush push;
};
layout(location = 0) out vec4 out_color;

void main() {
	const ivec2 last = textureSize(image, 0) - 1;
	const ivec2 texel = min(ivec2(gl_FragCoord.xy * push.image_px_per_window_px), last);
	out_color = texelFetch(image, texel, 0);
}
