#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "godot_addon/godot_addon_shared.h"

layout(set = 0, binding = CONVERT_BINDING_DEPTH) uniform texture2D depth_texture;
layout(push_constant) uniform Push {
	ConvertDepthPush push;
};

// Converts Godot's depth, which is 1 at the near plane and 0 at the far plane, to near / z. The background stays 0.
void main() {
	const float depth = texelFetch(depth_texture, ivec2(gl_FragCoord.xy), 0).r;
	gl_FragDepth = depth > 0.0 ? (depth + push.offset) / (1.0 + push.offset) : 0.0;
}
