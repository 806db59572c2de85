#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "shadow_planar/shadow_planar_shared.h"

// Initializes the mask: 1 at receivers, 0 elsewhere.
layout(set = 0, binding = PLANAR_BINDING_RECEIVERS) uniform texture2D receivers_texture;
layout(location = 0) out float out_visibility;

void main() {
	out_visibility = texelFetch(receivers_texture, ivec2(gl_FragCoord.xy), 0).r > 0.0 ? 1.0 : 0.0;
}
