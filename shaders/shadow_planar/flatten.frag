#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_planar/shadow_planar_shared.h"

// Writes the shadow of a flattened caster into the mask. Parts of the caster that are behind the
// plane, or higher than the light, hide nothing.
layout(location = 0) in float in_height_m;
layout(location = 0) out float out_visibility;
layout(push_constant) uniform Push {
	FlattenPush push;
};

void main() {
	if (in_height_m <= 0.0 || in_height_m >= push.max_height_m) {
		discard;
	}
	out_visibility = 0.0;
}
