#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "godot_addon/godot_addon_shared.h"
#include "godot_addon/surface_inc.glsl"

layout(set = 0, binding = SCALE_BINDING_FULL_DEPTH) uniform texture2D full_depth_texture;
layout(push_constant) uniform Push {
	ScalePush push;
};

// Writes the depth at the pixel's centre. It is extrapolated along the surface from the nearest pixel of the view.
void main() {
	const vec2 position = gl_FragCoord.xy * push.ratio;
	const ivec2 nearest = ivec2(position);
	const float depth = texelFetch(full_depth_texture, nearest, 0).r;
	gl_FragDepth = depth > 0.0 ? max(depth +
												 dot(find_slope(full_depth_texture, nearest),
														 position - (vec2(nearest) + 0.5)),
										 0.0)
							   : 0.0;
}
