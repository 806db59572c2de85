#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/insert_layer_inc.glsl"

// The cheap map: of each texel only so many faces that are turned away, those nearest to the light.
layout(constant_id = LAYERS_CONSTANT_COUNT) const uint LAYER_COUNT = 1u;

void main() {
	uint fragment = make_layer_fragment(uvec2(gl_FragCoord.xy));
	fragment = (fragment & LAYERS_KIND_MASK) == LAYERS_TOWARD ? 0u : fragment;
	const uint texel = uint(gl_FragCoord.y) * view.map_size_px.x + uint(gl_FragCoord.x);
	const uint place = view.index * push.fragment_capacity + texel * LAYER_COUNT;
	insert_layer_fragment(place, place + LAYER_COUNT, fragment);
}
