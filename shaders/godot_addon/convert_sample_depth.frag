#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "godot_addon/convert_depth_inc.glsl"

layout(set = 0, binding = CONVERT_BINDING_DEPTH) uniform texture2DMS depth_texture;
layout(set = 0, binding = CONVERT_BINDING_PUBLISHED, r32f) uniform writeonly image2D published_image;

// Writes the depth of each pixel's first sample, also for materials. The camera of the masks is shifted, so that its rays pass
// through these samples: the points are exactly on the surfaces that Godot draws, and no depth is made up between them.
void main() {
	const ivec2 pixel = ivec2(gl_FragCoord.xy);
	const float depth = convert_depth(texelFetch(depth_texture, pixel, 0).r);
	imageStore(published_image, pixel, vec4(depth));
	gl_FragDepth = depth;
}
