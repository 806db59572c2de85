#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "godot_addon/godot_addon_shared.h"

layout(set = 0, binding = MERGE_BINDING_SCENE) uniform texture2D scene_texture; // near / z, as Godot drew it
layout(set = 0, binding = MERGE_BINDING_DRAWN) uniform texture2D drawn_texture; // meshes of fewer triangles alone
layout(set = 0, binding = MERGE_BINDING_FULL) uniform texture2D full_texture;	// the same in full
layout(push_constant) uniform Push {
	MergeDepthPush push;
};

// Where Godot shows a mesh of fewer triangles, the depth of the full one, if that is there too.
void main() {
	const ivec2 pixel = ivec2(gl_FragCoord.xy);
	const float scene = texelFetch(scene_texture, pixel, 0).r;
	const float drawn = texelFetch(drawn_texture, pixel, 0).r;
	const float full = texelFetch(full_texture, pixel, 0).r;
	const bool is_drawn = drawn > 0.0 && abs(scene - drawn) <= push.same_share * drawn;
	const bool is_near = full > 0.0 && abs(scene - full) <= push.most_share * full;
	gl_FragDepth = is_drawn && is_near ? full : scene;
}
