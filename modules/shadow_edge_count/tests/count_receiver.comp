#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/count_edge_inc.glsl"

// Input 2 i: r; 2 i + 1: the normal. Output: visibility, solids at the reference, signed area.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) readonly buffer Input {
	vec4 items[];
};
layout(set = 0, binding = 1) writeonly buffer Output {
	vec4 results[];
};
layout(set = 0, binding = 2) uniform Constants {
	CountViewConstants view;
};
layout(set = 0, binding = 3) readonly buffer Edges {
	CountEdgeRecord edges[];
};
layout(set = 0, binding = 4) readonly buffer Texels {
	uvec2 texels[];
};
layout(set = 0, binding = 5) readonly buffer Fragments {
	vec2 fragments[];
};
layout(set = 0, binding = 6) readonly buffer Masks {
	uvec2 masks[];
};

uvec2 load_count_mask(uint p_index) {
	return masks[p_index];
}

uvec2 load_count_texel(uint p_index) {
	return texels[p_index];
}

vec2 load_count_fragment(uint p_index) {
	return fragments[p_index];
}

CountEdgePlanes load_count_planes(uint p_record) {
	return CountEdgePlanes(edges[p_record].plane0, edges[p_record].plane1);
}

void main() {
	const uint item = gl_GlobalInvocationID.x;
	if (2u * item >= uint(items.length())) {
		return;
	}
	const CountReceiver receiver =
			make_count_receiver(view, items[2u * item].xyz, items[2u * item + 1u].xyz);
	CountState state = make_count_state(find_count_reference(view, receiver));
	for (uint i = 0u; i < uint(edges.length()); ++i) {
		const CountEdgeRecord edge = edges[i];
		const uint use = (view.disc_radius > 0.0 ? COUNT_USE_AREA : 0u) |
				(edge.by_bw_weight_kind.z != 0.0 ? COUNT_USE_CENTER : 0u);
		count_add_edge(view, receiver, make_count_segment(edge.a_bx, edge.by_bw_weight_kind), i, use,
				state);
	}
	results[item] = vec4(count_resolve(state), float(state.reference.solid_count),
			state.area, 0.0);
}
