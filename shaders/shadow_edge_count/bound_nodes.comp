#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/node_bounds_inc.glsl"

// Computes the bounds of the nodes of three levels of both trees, from FIRST_LEVEL on. A work group has 64 nodes of
// the first of these levels, and those above them. Work groups in the first layer belong to the tree of faces, those in
// the second to the tree of edges.
const uint GROUP_SIZE = 64u;
layout(local_size_x = 64) in;
layout(constant_id = EDGE_COUNT_CONSTANT_FIRST_LEVEL) const uint FIRST_LEVEL = 1u;

shared CountNode group_nodes[GROUP_SIZE];

void main() {
	load_light();
	const bool has_faces = gl_WorkGroupID.z == 0u;
	const uint width = uint(EDGE_COUNT_NODE_WIDTH);
	const CountTree tree = make_count_tree(has_faces);
	const uint invocation = gl_LocalInvocationIndex;
	uint group_size = GROUP_SIZE; // nodes of the level that the work group has
	for (uint i = 0u; i < 3u; ++i) {
		const uint level = FIRST_LEVEL + i;
		const uint index = find_work_group() * group_size + invocation;
		const bool exists = level < uint(EDGE_COUNT_MAX_LEVELS) && invocation < group_size &&
				index < find_node_count(tree.item_count, level);
		NodeBounds bounds = make_node_bounds();
		if (exists) {
			const uint end = min((index + 1u) * width, find_node_count(tree.item_count, level - 1u));
			for (uint child = index * width; child < end; ++child) {
				if (i == 0u) {
					extend_bounds(unpack_node(nodes[find_node_index(tree, level - 1u, child)]), bounds);
				} else {
					extend_bounds(unpack_node(group_nodes[child % GROUP_SIZE % (group_size * width)]), bounds);
				}
			}
		}
		barrier();
		if (exists) {
			const CountNode node = pack_node(bounds);
			group_nodes[invocation] = node;
			nodes[find_node_index(tree, level, index)] = node;
		}
		barrier();
		group_size /= width;
	}
}
