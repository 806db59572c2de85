#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "shadow_penumbra_fins/shadow_penumbra_fins_shared.h"

// Depth peeling (Everitt 2001): what is not strictly deeper than the layer before is dropped, and the
// depth test keeps the nearest of the rest. Reversed depth: deeper is smaller, 0 is empty.
layout(set = 0, binding = PEEL_BINDING_NEARER) uniform texture2D nearer_texture;
layout(std430, set = 0, binding = PEEL_BINDING_FOUND) buffer Found {
	uint is_found; // not 0 once the layer holds anything: an empty one has nothing behind it
};

layout(constant_id = PEEL_CONSTANT_TELLS_FOUND) const bool TELLS_FOUND = true;

void main() {
	const float nearer = texelFetch(nearer_texture, ivec2(gl_FragCoord.xy), 0).r;
	// Depth clamp comes after this shader: compare what the test will store.
	if (clamp(gl_FragCoord.z, 0.0, 1.0) >= nearer) {
		discard;
	}
	// A loop and not a branch: software drivers run what a branch skips, but leave a loop.
	[[dont_unroll]] for (uint seen = TELLS_FOUND ? is_found : 1u; seen == 0u; seen = 1u) {
		atomicOr(is_found, 1u);
	}
}
