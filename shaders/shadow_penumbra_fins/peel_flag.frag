#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "shadow_penumbra_fins/peel_inc.glsl"

// As peel.frag, and sets a flag when the layer holds anything: behind an empty one there is nothing.
layout(std430, set = 0, binding = PEEL_BINDING_FOUND) buffer Found {
	uint is_found; // not 0 once it does
};

void main() {
	if (!is_deeper_than_nearer_layer()) {
		discard;
	}
	// A loop and not a branch: software drivers run what a branch skips, but leave a loop.
	[[dont_unroll]] for (uint seen = is_found; seen == 0u; seen = 1u) {
		atomicOr(is_found, 1u);
	}
}
