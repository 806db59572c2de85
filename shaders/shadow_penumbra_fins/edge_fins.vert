#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_penumbra_fins/fin_inc.glsl"
#include "shared/topology_shared.h"

// Extrudes fins from the listed silhouette edges, without a geometry shader and vertex buffers. Each edge has 6
// vertices, or 12 with both outer and inner fins.
layout(location = 0) out float out_theta;
layout(location = 1) flat out uint out_is_outer;
layout(std140, set = 0, binding = FINS_BINDING_CONSTANTS) uniform Constants {
	FinsViewConstants view;
};
layout(std430, set = 0, binding = FINS_BINDING_POSITIONS) readonly buffer Positions {
	vec4 positions_node[];
};
layout(std430, set = 0, binding = FINS_BINDING_NORMALS) readonly buffer Normals {
	vec4 normals_node[];
};
layout(std430, set = 0, binding = FINS_BINDING_EDGES) readonly buffer Edges {
	TopologyEdge edges[];
};
layout(std430, set = 0, binding = FINS_BINDING_LIST) readonly buffer List {
	uint edge_list[];
};
layout(push_constant) uniform Push {
	FinsPush push;
};
layout(constant_id = FINS_CONSTANT_HAS_OUTER) const bool HAS_OUTER = true;
layout(constant_id = FINS_CONSTANT_HAS_INNER) const bool HAS_INNER = true;

void main() {
	const uint half_count = (HAS_OUTER ? 1u : 0u) + (HAS_INNER ? 1u : 0u);
	const uint vertices_per_edge = FIN_HALF_CORNER_COUNT * half_count;
	const uint first_corner = HAS_OUTER ? FIN_FIRST_OUTER_CORNER : FIN_FIRST_INNER_CORNER;
	const TopologyEdge edge =
			edges[edge_list[push.first_in_list + uint(gl_VertexIndex) / vertices_per_edge]];
	const uint corner_index = first_corner + uint(gl_VertexIndex) % vertices_per_edge;
	const uint corner = FIN_CORNERS[corner_index];
	const uint vertex = (corner & 1u) != 0u ? edge.b : edge.a;
	gl_Position = fin_position_clip(
			view, push, corner, positions_node[vertex].xyz, normals_node[vertex].xyz);
	out_theta = fin_theta(corner);
	out_is_outer = corner_index < FIN_FIRST_INNER_CORNER ? 1u : 0u;
}
