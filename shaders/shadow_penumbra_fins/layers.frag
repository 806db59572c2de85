#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#include "shadow_penumbra_fins/shadow_penumbra_fins_shared.h"

// Finds up to three nearest distinct depths of each texel in one pass. Each texel has one slot per layer. A slot keeps
// the nearest depth that reaches it and passes the other one on to the next slot. The slots therefore end with the same
// layers as depth peeling, bit for bit, whatever the order of fragments. Depths are reversed and in 0..1, so that their
// bits have the same order as their values.
layout(std430, set = 0, binding = LAYERS_BINDING_TEXELS) buffer Texels {
	uint depth_bits[]; // all texels of the nearest layer, then of the next
};
layout(constant_id = LAYERS_CONSTANT_WIDTH_PX) const uint WIDTH_PX = 1u;
layout(constant_id = LAYERS_CONSTANT_TEXEL_COUNT) const uint TEXEL_COUNT = 1u;
layout(constant_id = FINS_CONSTANT_LAYER_COUNT) const uint LAYER_COUNT = 3u;

void main() {
	const uvec2 texel = uvec2(gl_FragCoord.xy);
	uint slot = texel.y * WIDTH_PX + texel.x;
	const uint end = slot + LAYER_COUNT * TEXEL_COUNT;
	uint depth = floatBitsToUint(clamp(gl_FragCoord.z, 0.0, 1.0)) & 0x7fffffffu; // -0 is 0
	// Slots only grow, so a depth that is not nearer than the last slot's can be dropped without an atomic.
	depth = depth > depth_bits[end - TEXEL_COUNT] ? depth : 0u;
	[[dont_unroll]] while (depth != 0u && slot < end) {
		const uint before = atomicMax(depth_bits[slot], depth);
		// Ends when the depth is stored already, or when the slot was empty (before = 0): nothing is passed on.
		depth = before == depth ? 0u : min(before, depth);
		slot += TEXEL_COUNT;
	}
}
