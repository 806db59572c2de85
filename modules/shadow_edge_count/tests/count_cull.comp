#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/count_box_inc.glsl"

// Input 2 i, 2 i + 1: a CountBlockBox. Output per box and edge: may the edge matter to a receiver of the box;
// what is known of its weight; are bundles of this edge alone, and of all edges, tested.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) readonly buffer Input {
	vec4 items[];
};
layout(set = 0, binding = 1) writeonly buffer Output {
	vec4 results[];
};
layout(std140, set = 0, binding = 2) restrict readonly buffer Constants {
	CountLightConstants light;
};
layout(set = 0, binding = 3) readonly buffer Edges {
	CountEdgeRecord edges[];
};
layout(set = 0, binding = 4) readonly buffer Planes {
	vec4 planes[];
};

vec3 get_a(uint p_edge) {
	return uintBitsToFloat(edges[p_edge].a_face0.xyz);
}
vec3 get_b(uint p_edge) {
	return uintBitsToFloat(edges[p_edge].b_face1.xyz);
}

CountEdgeBundle make_bundle(uint p_first, uint p_end) {
	vec3 least = vec3(COUNT_FAR);
	vec3 greatest = vec3(-COUNT_FAR);
	for (uint i = p_first; i < p_end; ++i) {
		least = min(least, min(get_a(i), get_b(i)));
		greatest = max(greatest, max(get_a(i), get_b(i)));
	}
	return CountEdgeBundle(vec4(0.5 * (least + greatest), 0.0), vec4(0.5001 * (greatest - least), 0.0));
}

void main() {
	const uint item = gl_GlobalInvocationID.x;
	const uint edge_count = uint(edges.length());
	const uint box_index = item / edge_count;
	const uint index = item % edge_count;
	if (2u * box_index >= uint(items.length())) {
		return;
	}
	const CountBox box = make_count_box(light, light.views[0],
			unpack_count_bounds(CountBlockBox(items[2u * box_index], items[2u * box_index + 1u])));
	const CountEdgeKind kind = make_count_kind(edges[index].a_face0.w, edges[index].b_face1.w);
	const uint known = find_known_weight(box, kind, planes[edges[index].a_face0.w & EDGE_COUNT_FACE_MASK],
			kind.has_face1 ? planes[edges[index].b_face1.w] : vec4(0.0));
	const ivec2 sides = ivec2(find_light_side(box, get_a(index)), find_light_side(box, get_b(index)));
	const bool is_used = is_edge_in_reach(box, get_a(index), get_b(index)) && known != COUNT_ADDS_NOTHING &&
			max(sides.x, sides.y) >= 0;
	results[item] = vec4(is_used ? 1.0 : 0.0,
			(known & COUNT_KNOWS_WEIGHT) != 0u ? float(get_known_weight(known)) : 9.0,
			may_use_bundle(box, make_bundle(index, index + 1u)) ? 1.0 : 0.0,
			may_use_bundle(box, make_bundle(0u, edge_count)) ? 1.0 : 0.0);
}
