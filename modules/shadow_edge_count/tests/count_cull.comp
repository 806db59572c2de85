#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/count_boxes_inc.glsl"
#include "shadow_edge_count/count_cull_inc.glsl"

// Input 2 i: least x', y', w of a box of receivers; 2 i + 1: greatest. Each is packed and unpacked first.
// Output per box and edge: what find_count_use gives, or 0 where a bundle of this edge alone is not asked;
// is the box bounded; is a bundle of all edges asked.
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
	const CountBounds bounds = unpack_count_bounds(view,
			pack_count_bounds(view,
					CountBounds(items[2u * box_index].xyz, items[2u * box_index + 1u].xyz)));
	const CountBox box = make_count_box(view, bounds.least, bounds.greatest);
	const CountEdgeRecord edge = edges[item % edge_count];
	const uint use = may_use_bundle(view, box, make_count_bundle(edge))
			? find_count_use(view, box, edge)
			: 0u;
	CountEdgeBundle all = make_count_bundle(edges[0]);
	for (uint i = 1u; i < edge_count; ++i) {
		all = join_count_bundles(all, make_count_bundle(edges[i]));
	}
	results[item] = vec4(float(use), box.is_bounded ? 1.0 : 0.0,
			may_use_bundle(view, box, all) ? 1.0 : 0.0, 0.0);
}
