#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/count_classify_inc.glsl"
#include "shadow_edge_count/count_box_inc.glsl"

// Input: items 3 i to 3 i + 2 are min_max, slope_range and the range of w of box i, see CountLeaf. Output per box and edge: x is 1 if the edge may matter to a
// receiver of the box, y is its weight if all receivers see the same one, else 9. z and w are 1 if the test of nodes
// accepts a node of this edge alone, and a node of all edges.
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

CountNode make_node(uint p_first, uint p_end) {
	vec3 minimum = vec3(COUNT_FAR);
	vec3 maximum = vec3(-COUNT_FAR);
	for (uint i = p_first; i < p_end; ++i) {
		minimum = min(minimum, min(get_a(i), get_b(i)));
		maximum = max(maximum, max(get_a(i), get_b(i)));
	}
	return CountNode(vec4(0.5 * (minimum + maximum), -COUNT_FAR),
			vec4(0.5001 * (maximum - minimum), COUNT_FAR)); // above 0.5 for rounding of the centre
}

void main() {
	const uint item = gl_GlobalInvocationID.x;
	const uint edge_count = uint(edges.length());
	const uint box_index = item / edge_count;
	const uint index = item % edge_count;
	if (3u * box_index >= uint(items.length())) {
		return;
	}
	const vec4 min_max = items[3u * box_index];
	const vec4 slope_range = items[3u * box_index + 1u];
	const CountBounds bounds =
			CountBounds(min_max.xy, min_max.zw, slope_range.xy, slope_range.zw, items[3u * box_index + 2u].xy);
	const CountBox box =
			make_count_box(light, light.disc_radius, make_count_frame(vec3(0.0, 0.0, 1.0)), bounds, 0.0, false);
	const CountEdgeKind kind = make_count_kind(edges[index].a_face0.w, edges[index].b_face1.w);
	const uint packed_weight = find_packed_weight(box, kind, planes[edges[index].a_face0.w & EDGE_COUNT_FACE_MASK],
			kind.has_face1 ? planes[edges[index].b_face1.w] : vec4(0.0));
	const ivec2 sides = ivec2(find_light_side(box, get_a(index)), find_light_side(box, get_b(index)));
	const bool is_used = is_edge_in_reach(box, get_a(index), get_b(index)) && packed_weight != COUNT_ADDS_NOTHING &&
			max(sides.x, sides.y) >= 0;
	results[item] = vec4(is_used ? 1.0 : 0.0,
			(packed_weight & COUNT_HAS_WEIGHT) != 0u ? float(unpack_weight(packed_weight)) : 9.0,
			is_node_in_reach(box, make_node(index, index + 1u)) ? 1.0 : 0.0,
			is_node_in_reach(box, make_node(0u, edge_count)) ? 1.0 : 0.0);
}
