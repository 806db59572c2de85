#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "godot_addon/godot_addon_shared.h"

layout(set = 0, binding = MERGE_BINDING_SCENE) uniform texture2D scene_texture; // near / z, as Godot drew it
layout(set = 0, binding = MERGE_BINDING_DRAWN) uniform texture2D drawn_texture; // reduced meshes as Godot draws them
layout(set = 0, binding = MERGE_BINDING_FULL) uniform texture2D full_texture; // the same meshes with all triangles
layout(push_constant) uniform Push {
	MergeDepthPush push;
};

// Where Godot drew a mesh with reduced triangles (a level of detail), writes the depth of the full mesh, if that covers
// the pixel at nearly the same depth.
void main() {
	const ivec2 pixel = ivec2(gl_FragCoord.xy);
	const float scene = texelFetch(scene_texture, pixel, 0).r;
	const float drawn = texelFetch(drawn_texture, pixel, 0).r;
	const float full = texelFetch(full_texture, pixel, 0).r;
	const bool is_drawn = drawn > 0.0 && abs(scene - drawn) <= push.surface_tolerance * drawn;
	const bool is_near = full > 0.0 && abs(scene - full) <= push.lod_tolerance * full;
	gl_FragDepth = is_drawn && is_near ? full : scene;
}
