#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_planar/shadow_planar_shared.h"

// What is behind the plane hides nothing of it, nor what is higher than the light.
layout(location = 0) in float in_height_m;
layout(location = 0) out float out_visibility;
layout(push_constant) uniform Push {
	PlanarPush push;
};

void main() {
	if (in_height_m <= 0.0 || in_height_m >= push.greatest_height_m) {
		discard;
	}
	out_visibility = 0.0;
}
