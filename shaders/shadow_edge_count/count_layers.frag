#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/shadow_edge_count_shared.h"

// How many fragments each texel of the layer map has.
layout(set = 0, binding = LAYERS_BINDING_VIEW) uniform View {
	CountViewConstants view;
};
layout(std430, set = 0, binding = LAYERS_BINDING_COUNTS) buffer Counts {
	uint counts[];
};

void main() {
	const uvec2 texel = uvec2(gl_FragCoord.xy);
	atomicAdd(counts[texel.y * view.map_size_px.x + texel.x], 1u);
}
