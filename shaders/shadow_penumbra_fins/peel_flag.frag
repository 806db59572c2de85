#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "shadow_penumbra_fins/peel_inc.glsl"

// Like peel.frag, but also sets a flag when the layer has a fragment. Without any, the layers behind it are empty too.
layout(std430, set = 0, binding = PEEL_BINDING_FOUND) buffer Found {
	uint is_found; // not 0: the layer has a fragment
};

void main() {
	if (!is_behind_previous_layer()) {
		discard;
	}
	// A loop instead of a branch: software drivers execute the code that a branch skips, but not a loop's body.
	[[dont_unroll]] for (uint seen = is_found; seen == 0u; seen = 1u) {
		atomicOr(is_found, 1u);
	}
}
