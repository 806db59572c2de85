// The record of one edge of a caster, for the passes that find edges. They have these buffers.
#ifndef CASTER_EDGE_INC_GLSL
#define CASTER_EDGE_INC_GLSL

#include "shadow_edge_count/count_classify_inc.glsl"

layout(set = 0, binding = FIND_BINDING_VIEW) uniform View {
	CountViewConstants view;
};
layout(std430, set = 0, binding = FIND_BINDING_POSITIONS) readonly buffer Positions {
	vec4 positions_node[];
};
layout(std430, set = 0, binding = FIND_BINDING_PLANES) readonly buffer Planes {
	vec4 planes_view[];
};
layout(std430, set = 0, binding = FIND_BINDING_EDGES) readonly buffer Edges {
	CountMeshEdge mesh_edges[];
};
layout(push_constant) uniform Push {
	CountCasterPush push;
};

/// False where no receiver counts the edge.
bool make_caster_record(uint p_edge_index, out CountEdgeRecord r_record) {
	const CountMeshEdge edge = mesh_edges[p_edge_index];
	const bool has_face1 = edge.face1 != EDGE_COUNT_NO_FACE;
	const bool is_mirrored = (push.kind & uint(EDGE_COUNT_MIRRORED)) != 0u;
	const vec3 a = (push.view_from_node * vec4(positions_node[edge.a].xyz, 1.0)).xyz;
	const vec3 b = (push.view_from_node * vec4(positions_node[edge.b].xyz, 1.0)).xyz;
	const vec4 plane0 = planes_view[push.first_face + edge.face0];
	vec4 plane1 = has_face1 ? planes_view[push.first_face + edge.face1] : vec4(0.0);
	plane1 = p_edge_index >= push.inconsistent_from ? -plane1 : plane1;
	const int kind = int(push.kind & uint(EDGE_COUNT_DOUBLE_SIDED)) |
			(has_face1 ? EDGE_COUNT_HAS_FACE1 : 0);
	return make_count_record(
			view, is_mirrored ? b : a, is_mirrored ? a : b, plane0, plane1, kind, r_record);
}

#endif
