#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/layer_fragment_inc.glsl"

// The cheap map: of each texel only so many faces that are turned away, those nearest to the light. Each
// place keeps the nearest value that came to it and hands the other on, so that the places end in
// order, whatever the order of the fragments.
layout(std430, set = 0, binding = LAYERS_BINDING_FRAGMENTS) buffer Fragments {
	uint fragments[];
};
layout(constant_id = LAYERS_CONSTANT_COUNT) const uint LAYER_COUNT = 1u;

void main() {
	uint fragment = make_layer_fragment(uvec2(gl_FragCoord.xy));
	fragment = (fragment & LAYERS_KIND_MASK) == LAYERS_TOWARD ? 0u : fragment;
	const uint texel = uint(gl_FragCoord.y) * view.map_size_px.x + uint(gl_FragCoord.x);
	uint place = view.index * push.fragment_capacity + texel * LAYER_COUNT;
	const uint end = place + LAYER_COUNT;
	// Places only grow: what the last one hides already can be dropped without an atomic.
	fragment = fragment > fragments[end - 1u] ? fragment : 0u;
	[[dont_unroll]] while (fragment != 0u && place < end) {
		fragment = min(atomicMax(fragments[place], fragment), fragment);
		++place;
	}
}
