#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#include "shadow_penumbra_fins/shadow_penumbra_fins_shared.h"

// The three nearest distinct depths of each texel in one pass. Each slot keeps the nearest value
// that came to it and hands the other on, so that the slots end as peeling's layers, bit for bit,
// whatever the order: slot i gets every value that i others are nearer than. Reversed depth in
// 0..1, whose bits are ordered as the numbers are.
layout(std430, set = 0, binding = LAYERS_BINDING_TEXELS) buffer Texels {
	uint depth_bits[]; // one plane per layer
};
layout(constant_id = LAYERS_CONSTANT_WIDTH_PX) const uint WIDTH_PX = 1u;
layout(constant_id = LAYERS_CONSTANT_TEXEL_COUNT) const uint TEXEL_COUNT = 1u;
layout(constant_id = FINS_CONSTANT_LAYER_COUNT) const uint LAYER_COUNT = 3u;

void main() {
	const uvec2 texel = uvec2(gl_FragCoord.xy);
	uint slot = texel.y * WIDTH_PX + texel.x;
	const uint end = slot + LAYER_COUNT * TEXEL_COUNT;
	uint depth = floatBitsToUint(clamp(gl_FragCoord.z, 0.0, 1.0)) & 0x7fffffffu; // -0 is 0
	// Slots only grow: what the last one hides already can be dropped without an atomic.
	depth = depth > depth_bits[end - TEXEL_COUNT] ? depth : 0u;
	[[dont_unroll]] while (depth != 0u && slot < end) {
		const uint before = atomicMax(depth_bits[slot], depth);
		// The same surface twice ends here; so does the first value of a slot, handing on nothing.
		depth = before == depth ? 0u : min(before, depth);
		slot += TEXEL_COUNT;
	}
}
