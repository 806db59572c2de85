#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/renderer_shared.h"

// A picture in a window of perhaps another size: nearest texel, values as they are stored.
layout(set = 0, binding = PRESENT_BINDING_PICTURE) uniform texture2D picture;
layout(push_constant) uniform Push {
	PresentPush push;
};
layout(location = 0) out vec4 out_color;

void main() {
	const ivec2 last = textureSize(picture, 0) - 1;
	const ivec2 texel = min(ivec2(gl_FragCoord.xy * push.picture_px_per_window_px), last);
	out_color = texelFetch(picture, texel, 0);
}
