#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "godot_addon/godot_addon_shared.h"

layout(set = 0, binding = SHOW_BINDING_MASKS) uniform texture2DArray masks_texture;
layout(location = 0) out vec4 out_color;
layout(push_constant) uniform Push {
	ShowMaskPush push;
};

// Draws a layer of the masks in grey. Pixels without a receiver are black.
void main() {
	const float mask = max(texelFetch(masks_texture, ivec3(gl_FragCoord.xy, push.layer), 0).r, 0.0);
	out_color = vec4(mask, mask, mask, 1.0);
}
