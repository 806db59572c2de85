#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/silhouette_inc.glsl"
#include "shadow_volume/volume_inc.glsl"

// GPU Gems 3, chapter 11: emits the polygons of a caster's shadow volume that belong to one triangle. A light-facing
// triangle has caps (a robust one also when it is back-facing, with the opposite winding). Each silhouette edge that
// the triangle owns has a side (robust: two sides, if the edge has two faces).
layout(triangles_adjacency) in;
// 42: 2 caps of 3 vertices, and 3 edges with 2 sides of 6.
layout(triangle_strip, max_vertices = 42) out;
layout(location = 0) in vec3 in_position_node[];
layout(location = 1) flat in uint in_vertex[];
layout(std430, set = 0, binding = VOLUMES_BINDING_FACE_FLAGS) readonly buffer FaceFlags {
	uint face_flags[];
};

void emit_corner(uint p_corner, bool p_is_far) {
	gl_Position = volume_position_clip(in_position_node[p_corner], p_is_far);
	EmitVertex();
}

void emit_triangle(uint p_a, uint p_b, uint p_c, bool p_is_far) {
	emit_corner(p_a, p_is_far);
	emit_corner(p_b, p_is_far);
	emit_corner(p_c, p_is_far);
	EndPrimitive();
}

void emit_side(uint p_a, uint p_b) {
	for (uint i = 0u; i < VOLUMES_VERTICES_PER_SIDE; ++i) {
		const uint corner = VOLUME_SIDE_CORNERS[i];
		emit_corner((corner & VOLUME_AT_B) != 0u ? p_b : p_a, (corner & VOLUME_AT_INFINITY) != 0u);
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
	const bool is_facing = is_light_facing(push.light_position_node, uvec3(ids[0], ids[2], ids[4]),
			positions[0], positions[2], positions[4]);
	const uint flags = face_flags[gl_PrimitiveIDIn];
	const bool is_solid = (flags & TOPOLOGY_FACE_NOT_SOLID) == 0u;
	const bool is_robust = volume_includes(ROBUST_FACES, is_solid);
	if (is_facing || is_robust) {
		const uint b = is_facing ? 2u : 4u;
		const uint c = is_facing ? 4u : 2u;
		emit_triangle(0u, b, c, /*p_is_far=*/false);
		if (HAS_FAR_CAP) {
			emit_triangle(0u, c, b, /*p_is_far=*/true);
		}
	}
	const uint found = find_owned_silhouettes(push.light_position_node, flags, ids, positions);
	for (uint edge = 0u; edge < 3u; ++edge) {
		if ((found & (1u << edge)) == 0u) {
			continue;
		}
		const uint first = 2u * edge;
		const uint second = (first + 2u) % 6u;
		const uint a = is_facing ? first : second;
		const uint b = is_facing ? second : first;
		emit_side(a, b);
		if (is_robust && (flags & (TOPOLOGY_FACE_HAS_BOUNDARY << edge)) == 0u) {
			emit_side(a, b);
		}
	}
}
