#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/silhouette_inc.glsl"
#include "shadow_volume/volume_inc.glsl"

// Extrudes the sides of the listed silhouette edges without a geometry shader: one side per edge or, if the caster has
// robust faces, two. A robust face has a volume of its own even if it faces away from the light (see "Robust parts" in
// doc/techniques/shadow_volume.md). At a silhouette edge between two robust faces, both volumes have the same side, with
// the same winding, so it is drawn twice. Otherwise the second side collapses to a point.
layout(std430, set = 0, binding = VOLUMES_BINDING_POSITIONS) readonly buffer Positions {
	vec4 positions_node[];
};
layout(std430, set = 0, binding = VOLUMES_BINDING_EDGES) readonly buffer Edges {
	TopologyEdge edges[];
};
layout(std430, set = 0, binding = VOLUMES_BINDING_LIST) readonly buffer List {
	uint edge_list[];
};

void main() {
	const uint per_edge = VOLUMES_VERTICES_PER_SIDE * (ROBUST_FACES != VOLUMES_FACES_NONE ? 2u : 1u);
	const uint index = uint(gl_VertexIndex);
	const TopologyEdge edge = edges[edge_list[push.first_in_list + index / per_edge]];
	const bool is_facing = is_light_facing(push.light_position_node, uvec3(edge.a, edge.b, edge.opposite0),
			positions_node[edge.a].xyz, positions_node[edge.b].xyz, positions_node[edge.opposite0].xyz);
	const uint corner = VOLUME_SIDE_CORNERS[index % VOLUMES_VERTICES_PER_SIDE];
	const bool is_second = index % per_edge >= VOLUMES_VERTICES_PER_SIDE;
	const bool is_boundary = edge.opposite1 == TOPOLOGY_NO_VERTEX;
	const bool is_robust = volume_includes(ROBUST_FACES, (edge.opposite1 & TOPOLOGY_EDGE_NOT_SOLID) == 0u);
	const bool is_collapsed = is_second && (is_boundary || !is_robust);
	const bool is_at_b = ((corner & VOLUME_AT_B) != 0u) == is_facing && !is_collapsed;
	gl_Position = volume_position_clip(positions_node[is_at_b ? edge.b : edge.a].xyz,
			(corner & VOLUME_AT_INFINITY) != 0u && !is_collapsed);
}
