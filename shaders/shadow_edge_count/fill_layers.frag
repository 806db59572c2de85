#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/insert_layer_inc.glsl"

// Writes the fragments of each texel, in no order, from its last place to its first; where there is no
// room for all texels' fragments, the nearest ones of each.
layout(std430, set = 0, binding = LAYERS_BINDING_COUNTS) buffer Counts {
	uint counts[];
};
layout(std430, set = 0, binding = LAYERS_BINDING_TEXELS) readonly buffer Texels {
	uvec2 texels[];
};

void main() {
	const uvec2 texel = uvec2(gl_FragCoord.xy);
	const uint place = texel.y * view.map_size_px.x + texel.x;
	const uvec2 range = texels[view.index * view.map_size_px.x * view.map_size_px.y + place];
	const uint fragment = make_layer_fragment(texel);
	if ((range.y & LAYERS_ONLY_NEAREST) != 0u) {
		insert_layer_fragment(range.x, range.x + (range.y & LAYERS_COUNT_MASK), fragment);
		return;
	}
	const uint left = atomicAdd(counts[place], 0xffffffffu); // one less
	if (left >= 1u) {
		fragments[range.x + left - 1u] = fragment;
	}
}
