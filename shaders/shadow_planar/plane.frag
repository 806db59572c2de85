#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "common/depth_inc.glsl"
#include "common/normal_inc.glsl"
#include "shadow_planar/shadow_planar_shared.h"

// Marks the pixels of one receiver plane in the stencil, by discarding all others.
layout(std140, set = 0, binding = PLANAR_BINDING_FRAME) restrict readonly buffer Frame {
	FrameConstants frame;
};
layout(set = 0, binding = PLANAR_BINDING_DEPTH) uniform texture2D depth_texture;
layout(set = 0, binding = PLANAR_BINDING_NORMAL) uniform utexture2D normal_texture;
layout(set = 0, binding = PLANAR_BINDING_RECEIVERS) uniform texture2D receivers_texture;
layout(push_constant) uniform Push {
	PlanePush push;
};

const float MIN_COSINE = 0.9999; // between the pixel's normal and the plane's: at most 0.8 degrees

void main() {
	const ivec2 pixel = ivec2(gl_FragCoord.xy);
	if (texelFetch(receivers_texture, pixel, 0).r <= 0.0) {
		discard;
	}
	const vec3 position = position_from_depth(frame, pixel, texelFetch(depth_texture, pixel, 0).r);
	const vec3 normal = unpack_normal(texelFetch(normal_texture, pixel, 0).r);
	const float height_m = dot(push.plane.xyz, position) + push.plane.w;
	const float tolerance_m = push.tolerance_m + push.tolerance_per_distance * length(position);
	if (abs(height_m) > tolerance_m || dot(normal, push.plane.xyz) < MIN_COSINE) {
		discard;
	}
}
