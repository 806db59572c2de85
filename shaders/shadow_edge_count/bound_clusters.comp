#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/compute_extensions_inc.glsl"
#include "shadow_edge_count/light_faces_inc.glsl"
#include "shadow_edge_count/node_bounds_inc.glsl"

// Computes the bounds of each cluster of faces, and of each cluster of edges of a light's list. One invocation per
// cluster: work groups in the first layer have clusters of faces, those in the second clusters of edges.
layout(local_size_x = 64) in;
FETCHED_UVEC4S(COUNT_BINDING_EDGES, edges_buffer); // CountEdgeRecord

NodeBounds find_face_bounds(uint p_face) {
	const CountFaceRecord face = load_count_face(p_face);
	const vec4 a = uintBitsToFloat(face.a_kind);
	const vec4 b = uintBitsToFloat(face.b_first_distance);
	const vec4 c = uintBitsToFloat(face.c_end_distance);
	return NodeBounds(min(a.xyz, min(b.xyz, c.xyz)), max(a.xyz, max(b.xyz, c.xyz)), vec2(b.w, c.w));
}

NodeBounds find_edge_bounds(uint p_edge) {
	const uvec4 a_face0 = FETCH_UVEC4(edges_buffer, 2u * p_edge);
	const vec3 a = uintBitsToFloat(a_face0.xyz);
	const vec3 b = uintBitsToFloat(FETCH_UVEC4(edges_buffer, 2u * p_edge + 1u).xyz);
	return NodeBounds(min(a, b), max(a, b), load_distances(a_face0.w));
}

void main() {
	load_light();
	const bool has_faces = gl_WorkGroupID.z == 0u;
	const uint size = uint(EDGE_COUNT_CLUSTER_SIZE);
	const uint cluster = find_work_item(64u);
	const CountTree tree = make_count_tree(has_faces);
	if (cluster * size >= tree.item_count) {
		return;
	}
	NodeBounds bounds = make_node_bounds();
	for (uint i = cluster * size; i < min((cluster + 1u) * size, tree.item_count); ++i) {
		if (has_faces) {
			extend_bounds(find_face_bounds(i), bounds);
		} else {
			extend_bounds(find_edge_bounds(i), bounds);
		}
	}
	nodes[find_node_index(tree, 0u, cluster)] = pack_node(bounds);
}
