#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_volume/culling_shared.h"

// The farthest depth of the triangle's plane within the texel; reversed depth is linear there.
layout(depth_less) out float gl_FragDepth;
layout(push_constant) uniform Push {
	OccluderPush push;
};

// Half a texel each way, and what the rasteriser rounds.
const float REACH_PX = 0.75;

void main() {
	// Perspective: depth = near / w. A neighbour's depth may be clamped at the near plane, its w is not.
	const float depth = push.near_m > 0.0 ? push.near_m * gl_FragCoord.w : gl_FragCoord.z;
	const float change = abs(dFdxFine(depth)) + abs(dFdyFine(depth));
	gl_FragDepth = clamp(depth - REACH_PX * change, 0.0, gl_FragCoord.z);
}
