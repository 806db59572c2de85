#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/count_cull_inc.glsl"

// Input 2 i: least x', y', w of a box of receivers; 2 i + 1: greatest. Output per box and edge: what
// find_count_use gives, is the box bounded.
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

void main() {
	const uint item = gl_GlobalInvocationID.x;
	const uint edge_count = uint(edges.length());
	const uint box_index = item / edge_count;
	if (2u * box_index >= uint(items.length())) {
		return;
	}
	const CountBox box =
			make_count_box(view, items[2u * box_index].xyz, items[2u * box_index + 1u].xyz);
	const uint use = find_count_use(view, box, edges[item % edge_count]);
	results[item] = vec4(float(use), box.is_bounded ? 1.0 : 0.0, 0.0, 0.0);
}
