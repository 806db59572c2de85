#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/silhouette_inc.glsl"
#include "shadow_penumbra_fins/fin_inc.glsl"

// Sun et al. 2010, section 2.1.1: finds the silhouette edges of one triangle from its neighbours and
// emits their fins.
layout(triangles_adjacency) in;
layout(triangle_strip, max_vertices = 36) out; // 3 edges with up to 12 corners
layout(location = 0) in vec3 in_position_node[];
layout(location = 1) in vec3 in_normal_node[];
layout(location = 2) flat in uint in_vertex[];
layout(location = 0) out float out_theta;
layout(location = 1) flat out uint out_is_outer;
layout(std140, set = 0, binding = FINS_BINDING_CONSTANTS) uniform Constants {
	FinsViewConstants view;
};
layout(std430, set = 0, binding = FINS_BINDING_FACE_FLAGS) readonly buffer FaceFlags {
	uint face_flags[];
};
layout(push_constant) uniform Push {
	FinsPush push;
};
layout(constant_id = FINS_CONSTANT_HAS_OUTER) const bool HAS_OUTER = true;
layout(constant_id = FINS_CONSTANT_HAS_INNER) const bool HAS_INNER = true;

void emit_half(uint p_b, uint p_c, uint p_first_corner) {
	for (uint i = 0u; i < FIN_HALF_CORNER_COUNT; ++i) {
		const uint corner = FIN_CORNERS[p_first_corner + i];
		const uint vertex = (corner & 1u) != 0u ? p_c : p_b;
		gl_Position = fin_position_clip(
				view, push, corner, in_position_node[vertex], in_normal_node[vertex]);
		out_theta = fin_theta(corner);
		out_is_outer = p_first_corner == FIN_FIRST_OUTER_CORNER ? 1u : 0u;
		EmitVertex();
		if (i % 3u == 2u) {
			EndPrimitive();
		}
	}
}

void main() {
	uint ids[6];
	vec3 positions[6];
	for (int i = 0; i < 6; ++i) {
		ids[i] = in_vertex[i];
		positions[i] = in_position_node[i];
	}
	const uint found = find_owned_silhouettes(
			push.light_position_node, face_flags[gl_PrimitiveIDIn], ids, positions);
	for (uint edge = 0u; edge < 3u; ++edge) {
		if ((found & (1u << edge)) == 0u) {
			continue;
		}
		const uint b = 2u * edge;
		const uint c = (b + 2u) % 6u;
		if (HAS_OUTER) {
			emit_half(b, c, FIN_FIRST_OUTER_CORNER);
		}
		if (HAS_INNER) {
			emit_half(b, c, FIN_FIRST_INNER_CORNER);
		}
	}
}
