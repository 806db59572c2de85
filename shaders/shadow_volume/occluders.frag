#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_volume/culling_shared.h"

// Writes the farthest depth of the triangle's plane within the texel. Reversed depth is linear on a plane.
layout(depth_less) out float gl_FragDepth;
layout(push_constant) uniform Push {
	OccluderPush push;
};

// Half a texel in each direction, plus the rasteriser's rounding.
const float REACH_PX = 0.75;

void main() {
	// Perspective: depth = near / w. In a neighbouring pixel depth may be clamped at the near plane, but w is not.
	const float depth = push.near_m > 0.0 ? push.near_m * gl_FragCoord.w : gl_FragCoord.z;
	const float change = abs(dFdxFine(depth)) + abs(dFdyFine(depth));
	gl_FragDepth = clamp(depth - REACH_PX * change, 0.0, gl_FragCoord.z);
}
