// Which nodes of the trees may matter to a leaf. Include it after SUBGROUP_SIZE is defined.
#ifndef LEAF_TESTS_INC_GLSL
#define LEAF_TESTS_INC_GLSL

#include "shadow_edge_count/count_sweep_inc.glsl"
#include "shadow_edge_count/leaf_box_inc.glsl"

// The leaf, set by prepare_leaf_tests.
vec3 anchor;
CountBox box;	   // for what may matter to any of its receivers
CountBox hull_box; // for what may be between its receivers and the light's centre
vec3 hull_minimum; // of the receivers
vec3 hull_maximum;
vec3 shaft_minimum; // of the receivers and the light
vec3 shaft_maximum;

void prepare_leaf_tests(CountLeaf p_leaf) {
	const CountBounds bounds = unpack_count_bounds(p_leaf);
	anchor = p_leaf.anchor_block.xyz;
	box = make_leaf_box(p_leaf, bounds, light.disc_radius);
	hull_box = make_leaf_box(p_leaf, bounds, 0.0);
	hull_minimum = p_leaf.minimum_w.xyz;
	hull_maximum = p_leaf.maximum_w.xyz;
	const vec3 reach = IS_DIRECTIONAL ? vec3(COUNT_FAR) : vec3(light.disc_radius);
	shaft_minimum = IS_DIRECTIONAL ? -reach : min(hull_minimum, -reach);
	shaft_maximum = IS_DIRECTIONAL ? reach : max(hull_maximum, reach);
}

bool overlaps(CountNode p_node, vec3 p_minimum, vec3 p_maximum) {
	const vec3 center = p_node.center_first_distance.xyz;
	const vec3 half_size = p_node.half_size_end_distance.xyz;
	return all(lessThanEqual(center - half_size, p_maximum)) && all(greaterThanEqual(center + half_size, p_minimum));
}

/// False if no face of the node is on the anchor's way to the light's centre or between receivers of the leaf.
bool may_have_faces(CountNode p_node) {
	const float lowest = find_linear(hull_box.below, p_node.center_first_distance.xyz) -
			dot(abs(hull_box.below.xyz), p_node.half_size_end_distance.xyz);
	const bool is_between = overlaps(p_node, hull_minimum, hull_maximum) && is_node_in_reach(hull_box, p_node) &&
			lowest <= hull_box.margin;
	return is_in_distance_range(hull_box.distance, p_node) && (hull_box.is_wide || is_between || is_node_on_way(anchor, p_node));
}

/// False if no edge of the node matters to any receiver of the leaf.
bool may_have_edges(CountNode p_node) {
	return overlaps(p_node, shaft_minimum, shaft_maximum) && is_node_in_reach(box, p_node);
}

/// Whether faces or edges of a node may matter.
bool may_matter(CountNode p_node, bool p_has_faces) {
	return p_has_faces ? may_have_faces(p_node) : may_have_edges(p_node);
}

#endif
