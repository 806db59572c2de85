#version 460
#extension GL_GOOGLE_include_directive : require
#include "editor/ui_shared.h"

// Draws text, widgets and images: a texture times a colour. All values are sRGB-encoded and are not converted.
layout(set = 0, binding = UI_BINDING_TEXTURE) uniform texture2D shown_texture;
layout(set = 0, binding = UI_BINDING_SAMPLER) uniform sampler shown_sampler;
layout(location = 0) in vec2 in_uv;
layout(location = 1) in vec4 in_color;
layout(location = 0) out vec4 out_color;

void main() {
	out_color = in_color * texture(sampler2D(shown_texture, shown_sampler), in_uv);
}
