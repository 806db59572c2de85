#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "common/fetch_inc.glsl"
#include "shadow_edge_count/node_bounds_inc.glsl"

// Computes the bounds of each cluster of faces, and of each cluster of edges of a light's list. One invocation per
// cluster: work groups in the first layer have clusters of faces, those in the second clusters of edges.
layout(local_size_x = 64) in;
FETCHED_UVEC4S(FIND_BINDING_EDGES, edges_buffer); // CountEdgeRecord
FETCHED_UVEC4S(FIND_BINDING_FACES, faces_buffer); // CountFaceRecord

NodeBounds find_face_bounds(uint p_face) {
	const vec4 a = uintBitsToFloat(FETCH_UVEC4(faces_buffer, 3u * p_face));
	const vec4 b = uintBitsToFloat(FETCH_UVEC4(faces_buffer, 3u * p_face + 1u));
	const vec4 c = uintBitsToFloat(FETCH_UVEC4(faces_buffer, 3u * p_face + 2u));
	return NodeBounds(min(a.xyz, min(b.xyz, c.xyz)), max(a.xyz, max(b.xyz, c.xyz)), vec2(b.w, c.w));
}

NodeBounds find_edge_bounds(uint p_edge) {
	const uvec4 a_face0 = FETCH_UVEC4(edges_buffer, 2u * p_edge);
	const vec3 a = uintBitsToFloat(a_face0.xyz);
	const vec3 b = uintBitsToFloat(FETCH_UVEC4(edges_buffer, 2u * p_edge + 1u).xyz);
	const uint face = 3u * min(a_face0.w & EDGE_COUNT_FACE_MASK, light.face_count - 1u);
	return NodeBounds(min(a, b), max(a, b),
			vec2(uintBitsToFloat(FETCH_UVEC4(faces_buffer, face + 1u).w),
					uintBitsToFloat(FETCH_UVEC4(faces_buffer, face + 2u).w)));
}

void main() {
	const bool has_faces = gl_WorkGroupID.z == 0u;
	const uint size = uint(EDGE_COUNT_CLUSTER_SIZE);
	const uint cluster = find_work_item(64u);
	const uint item_count = find_item_count(has_faces);
	if (cluster * size >= item_count) {
		return;
	}
	NodeBounds bounds = make_node_bounds();
	for (uint i = cluster * size; i < min((cluster + 1u) * size, item_count); ++i) {
		if (has_faces) {
			extend_bounds(find_face_bounds(i), bounds);
		} else {
			extend_bounds(find_edge_bounds(i), bounds);
		}
	}
	nodes[find_first_node(has_faces, 0u) + cluster] = pack_node(bounds);
}
