#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "godot_addon/convert_depth_inc.glsl"

layout(set = 0, binding = CONVERT_BINDING_DEPTH) uniform texture2D depth_texture;

void main() {
	gl_FragDepth = convert_depth(texelFetch(depth_texture, ivec2(gl_FragCoord.xy), 0).r);
}
