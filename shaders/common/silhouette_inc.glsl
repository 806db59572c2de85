// Tests whether an edge is a silhouette as seen from the light. All shaders and the tests' version
// in C++ (find_silhouette_edges in mesh_tools/tests/silhouette_edges.h) evaluate the same
// expression: in float32, each product and sum rounded once, with vertices in an order that does
// not depend on the caller. So all find exactly the same edges.
#ifndef SILHOUETTE_INC_GLSL
#define SILHOUETTE_INC_GLSL

#include "shared/topology_shared.h"

/// True when the light is strictly in front of the triangle. All in node space. p_light: xyz / w is the light's centre;
/// w = 0: xyz is the direction towards a light at infinity. p_ids: the triangle's vertex indices.
bool is_light_facing(vec4 p_light, uvec3 p_ids, vec3 p_a, vec3 p_b, vec3 p_c) {
	// Start with the vertex of the lowest index, so that a face and its neighbours compute with the same order.
	vec3 p = p_a;
	vec3 q = p_b;
	vec3 r = p_c;
	if (p_ids.y < p_ids.x && p_ids.y < p_ids.z) {
		p = p_b;
		q = p_c;
		r = p_a;
	} else if (p_ids.z < p_ids.x && p_ids.z < p_ids.y) {
		p = p_c;
		q = p_a;
		r = p_b;
	}
	precise const vec3 u = q - p;
	precise const vec3 v = r - p;
	precise const vec3 to_light = p_light.xyz - p * p_light.w;
	precise const float nx = u.y * v.z - u.z * v.y;
	precise const float ny = u.z * v.x - u.x * v.z;
	precise const float nz = u.x * v.y - u.y * v.x;
	precise const float side = (nx * to_light.x + ny * to_light.y) + nz * to_light.z;
	return side > 0.0;
}

/// True when the edge a -> b is a silhouette. p_is_first_facing: its first face, which winds a -> b, faces the light.
/// The second face has the vertices b, a, c. When the edge is inconsistent, the second face is a, b, c and also winds
/// a -> b, so its front and back are swapped. p_ids: indices of a, b, c.
bool is_edge_silhouette(vec4 p_light, bool p_is_first_facing, uvec3 p_ids, vec3 p_a, vec3 p_b, vec3 p_c,
		bool p_is_inconsistent) {
	return p_is_inconsistent
			? p_is_first_facing == is_light_facing(p_light, p_ids, p_a, p_b, p_c)
			: p_is_first_facing != is_light_facing(p_light, p_ids.yxz, p_b, p_a, p_c);
}

/// Index of the vertex opposite to the edge in its second face. Invalid for a boundary edge: first test whether
/// opposite1 is TOPOLOGY_NO_VERTEX.
uint get_second_opposite(TopologyEdge p_edge) {
	return p_edge.opposite1 & ~uint(TOPOLOGY_EDGE_INCONSISTENT | TOPOLOGY_EDGE_NOT_SOLID);
}

/// True when an edge with two faces is a silhouette. p_a, p_b, p_first, p_second: positions of its vertices a, b,
/// opposite0 and get_second_opposite.
bool is_edge_record_silhouette(
		vec4 p_light, TopologyEdge p_edge, vec3 p_a, vec3 p_b, vec3 p_first, vec3 p_second) {
	const bool is_first_facing = is_light_facing(
			p_light, uvec3(p_edge.a, p_edge.b, p_edge.opposite0), p_a, p_b, p_first);
	const uint second = get_second_opposite(p_edge);
	return is_edge_silhouette(p_light, is_first_facing, uvec3(p_edge.a, p_edge.b, second), p_a, p_b, p_second,
			(p_edge.opposite1 & TOPOLOGY_EDGE_INCONSISTENT) != 0u);
}

/// For geometry shaders: bit i is set when edge i of the face is a silhouette that the face owns. Each edge is owned by
/// one face only, so that it is not drawn twice. p_ids, p_positions: as in a triangle with adjacency. p_flags:
/// TOPOLOGY_FACE_*.
uint find_owned_silhouettes(vec4 p_light, uint p_flags, uint p_ids[6], vec3 p_positions[6]) {
	if ((p_flags & 7u) == 0u) { // none of the three TOPOLOGY_FACE_OWNS_EDGE bits
		return 0u;
	}
	const bool is_facing = is_light_facing(p_light, uvec3(p_ids[0], p_ids[2], p_ids[4]),
			p_positions[0], p_positions[2], p_positions[4]);
	uint found = 0u;
	for (uint edge = 0u; edge < 3u; ++edge) {
		const uint a = 2u * edge;
		const uint b = (a + 2u) % 6u;
		bool is_silhouette = (p_flags & (TOPOLOGY_FACE_HAS_BOUNDARY << edge)) != 0u;
		if (!is_silhouette) {
			const uint c = a + 1u;
			is_silhouette = is_edge_silhouette(p_light, is_facing,
					uvec3(p_ids[a], p_ids[b], p_ids[c]), p_positions[a], p_positions[b], p_positions[c],
					(p_flags & (TOPOLOGY_FACE_HAS_INCONSISTENT << edge)) != 0u);
		}
		const bool is_owned = (p_flags & (TOPOLOGY_FACE_OWNS_EDGE << edge)) != 0u;
		found |= is_owned && is_silhouette ? 1u << edge : 0u;
	}
	return found;
}

#endif
