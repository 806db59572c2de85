// The bounds of nodes, and where they are written.
#ifndef NODE_BOUNDS_INC_GLSL
#define NODE_BOUNDS_INC_GLSL

#include "common/work_rows_inc.glsl"
#include "shadow_edge_count/light_trees_inc.glsl"

layout(std430, set = 0, binding = COUNT_BINDING_NODES) buffer Nodes {
	CountNode nodes[];
};

const float FAR = 3e38;

/// A box, and a range of distances. Empty if the minimum exceeds the maximum.
struct NodeBounds {
	vec3 minimum;
	vec3 maximum;
	vec2 distances;
};

NodeBounds make_node_bounds() {
	return NodeBounds(vec3(FAR), vec3(-FAR), vec2(FAR, -FAR));
}

void extend_bounds(NodeBounds p_other, inout NodeBounds r_bounds) {
	r_bounds.minimum = min(r_bounds.minimum, p_other.minimum);
	r_bounds.maximum = max(r_bounds.maximum, p_other.maximum);
	r_bounds.distances = vec2(min(r_bounds.distances.x, p_other.distances.x), max(r_bounds.distances.y, p_other.distances.y));
}

NodeBounds unpack_node(CountNode p_node) {
	const vec3 center = p_node.center_first_distance.xyz;
	const vec3 half_size = p_node.half_size_end_distance.xyz;
	return NodeBounds(center - half_size, center + half_size,
			vec2(p_node.center_first_distance.w, p_node.half_size_end_distance.w));
}

/// The bounds must not be empty.
CountNode pack_node(NodeBounds p_bounds) {
	// For rounding: fractions of the half size and of the centre's coordinates.
	const float WIDENING = 1.0001;
	const float CENTER_ROUNDING = 1e-6;
	const vec3 center = 0.5 * p_bounds.minimum + 0.5 * p_bounds.maximum;
	const vec3 half_size = max(p_bounds.maximum - center, center - p_bounds.minimum);
	return CountNode(vec4(center, p_bounds.distances.x),
			vec4(WIDENING * half_size + CENTER_ROUNDING * abs(center), p_bounds.distances.y));
}

#endif
