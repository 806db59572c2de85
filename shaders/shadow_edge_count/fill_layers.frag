#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/layer_fragment_inc.glsl"

// Writes the fragments of each texel, in no order, from its last place to its first.
layout(std430, set = 0, binding = LAYERS_BINDING_COUNTS) buffer Counts {
	uint counts[];
};
layout(std430, set = 0, binding = LAYERS_BINDING_TEXELS) readonly buffer Texels {
	uvec2 texels[];
};
layout(std430, set = 0, binding = LAYERS_BINDING_FRAGMENTS) writeonly buffer Fragments {
	uint fragments[];
};

void main() {
	const uvec2 texel = uvec2(gl_FragCoord.xy);
	const uint place = texel.y * view.map_size_px.x + texel.x;
	const uint left = atomicAdd(counts[place], 0xffffffffu); // one less
	const uint first = texels[view.index * view.map_size_px.x * view.map_size_px.y + place].x;
	const uint index = first + left - 1u;
	if (left >= 1u && index < (view.index + 1u) * push.fragment_capacity) {
		fragments[index] = make_layer_fragment(texel);
	}
}
