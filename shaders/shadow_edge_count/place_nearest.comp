#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/shadow_edge_count_shared.h"

// Before the cheap map is drawn: each texel has places for so many fragments, all empty.
layout(local_size_x = LAYERS_GROUP_SIZE) in;
layout(set = 0, binding = LAYERS_BINDING_VIEW) uniform View {
	CountViewConstants view;
};
layout(std430, set = 0, binding = LAYERS_BINDING_TEXELS) writeonly buffer Texels {
	uvec2 texels[];
};
layout(std430, set = 0, binding = LAYERS_BINDING_FRAGMENTS) writeonly buffer Fragments {
	uint fragments[];
};
layout(push_constant) uniform Push {
	CountPartPush push;
};
layout(constant_id = LAYERS_CONSTANT_COUNT) const uint LAYER_COUNT = 1u;

void main() {
	const uint texel_count = view.map_size_px.x * view.map_size_px.y;
	const uint texel = gl_GlobalInvocationID.x;
	if (texel >= texel_count) {
		return;
	}
	const uint first = view.index * push.fragment_capacity + texel * LAYER_COUNT;
	texels[view.index * texel_count + texel] = uvec2(first, LAYER_COUNT | LAYERS_ONLY_AWAY);
	for (uint i = 0u; i < LAYER_COUNT; ++i) {
		fragments[first + i] = 0u;
	}
}
