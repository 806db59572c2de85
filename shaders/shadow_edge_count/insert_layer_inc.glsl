// A texel's places for its nearest fragments.
#ifndef INSERT_LAYER_INC_GLSL
#define INSERT_LAYER_INC_GLSL

#extension GL_EXT_control_flow_attributes : require

#include "shadow_edge_count/layer_fragment_inc.glsl"

layout(std430, set = 0, binding = LAYERS_BINDING_FRAGMENTS) buffer Fragments {
	uint fragments[];
};

/// Each place keeps the nearest value that came to it and hands the other on, so that the places end in
/// order, whatever the order of the fragments. The places are 0 before.
void insert_layer_fragment(uint p_place, uint p_end, uint p_fragment) {
	uint place = p_place;
	// Places only grow: what the last one hides already can be dropped without an atomic.
	uint fragment = place < p_end && p_fragment > fragments[p_end - 1u] ? p_fragment : 0u;
	[[dont_unroll]] while (fragment != 0u && place < p_end) {
		fragment = min(atomicMax(fragments[place], fragment), fragment);
		++place;
	}
}

#endif
