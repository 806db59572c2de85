#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/compute_extensions_inc.glsl"
#include "shadow_edge_count/casters_inc.glsl"
#include "shadow_edge_count/count_classify_inc.glsl"

// Computes the vertices and planes of the casters' faces in light space, and the distances of the leaves that
// see them (see CountFaceRecord). One invocation per face.
layout(local_size_x = FIND_GROUP_SIZE) in;
FETCHED_UVEC4S(FIND_BINDING_MESH_FACES, mesh_faces_buffer); // of all meshes: CountMeshFace
layout(std430, set = 0, binding = COUNT_BINDING_PLANES) writeonly buffer Planes {
	vec4 planes[];
};
layout(std430, set = 0, binding = COUNT_BINDING_FACES) writeonly buffer Faces {
	CountFaceRecord faces[];
};

/// The distance of a leaf from which on the penumbra at a source part of the mesh
/// has at least this half width. p_source_part: centre and radius in light space. Precise, so that the range of one
/// LOD ends exactly where that of the other begins. Derived in "Levels of detail" in
/// doc/techniques/edge_count.md.
float find_switch_distance(vec4 p_source_part, float p_half_width) {
	precise const float reach = p_half_width / push.disc_radius; // directional: in metres, else a fraction
	precise const float directional_distance = p_source_part.z + p_source_part.w + reach;
	precise const float point_light_distance = (length(p_source_part.xyz) + p_source_part.w) / (1.0 - reach);
	if (p_half_width <= 0.0) {
		return -COUNT_FAR;
	}
	if (push.is_directional != 0u) {
		return reach < COUNT_FAR ? directional_distance : COUNT_FAR;
	}
	return reach < 1.0 ? point_light_distance : COUNT_FAR;
}

/// The distances of the leaves that see the face, see CountFaceRecord.
vec2 find_distances(CountCasterRecord p_caster, uint p_source_part) {
	if ((p_caster.flags & EDGE_COUNT_CASTER_LOD) == 0u) {
		return vec2(-COUNT_FAR, COUNT_FAR);
	}
	const vec4 part_node = FETCH_VEC4(points_buffer, p_caster.first_source_part + p_source_part);
	precise const vec3 center = (p_caster.light_from_node * vec4(part_node.xyz, 1.0)).xyz;
	precise const vec4 part = vec4(center, p_caster.scale * part_node.w);
	return vec2(find_switch_distance(part, p_caster.first_half_width), find_switch_distance(part, p_caster.end_half_width));
}

CountMeshFace load_mesh_face(CountCasterRecord p_caster, uint p_index) {
	const uint first = p_caster.first_mesh_face + uint(EDGE_COUNT_MESH_FACE_ITEMS) * p_index;
	const uvec4 corners = FETCH_UVEC4(mesh_faces_buffer, first);
	const uvec4 plane = FETCH_UVEC4(mesh_faces_buffer, first + 1u);
	return CountMeshFace(corners.x, corners.y, corners.z, corners.w, plane.x, plane.y, plane.z, plane.w);
}

void main() {
	const CountWorkGroup group = load_work_group();
	const uint index = group.index * uint(FIND_GROUP_SIZE) + gl_LocalInvocationID.x;
	if (group.index == NO_GROUP || index >= push.item_count) {
		return;
	}
	const CountCasterRecord caster = load_caster(find_caster(group, /*p_is_word=*/false, index));
	const CountMeshFace face = load_mesh_face(caster, index - caster.first_face);
	const vec3 a = load_light_position(caster, face.a);
	const vec3 b = load_light_position(caster, face.b);
	const vec3 c = load_light_position(caster, face.c);
	const vec4 plane = make_count_plane(load_light_position(caster, face.plane_a),
			load_light_position(caster, face.plane_b), load_light_position(caster, face.plane_c));
	const bool is_mirrored = (caster.flags & EDGE_COUNT_CASTER_MIRRORED) != 0u;
	planes[index] = is_mirrored ? -plane : plane;
	const vec2 distances = find_distances(caster, face.kind & EDGE_COUNT_SOURCE_PART_MASK);
	// Mirroring inverts the winding, so two vertices are swapped to match the plane's front.
	faces[index] = CountFaceRecord(uvec4(floatBitsToUint(a), face.kind & ~EDGE_COUNT_SOURCE_PART_MASK),
			floatBitsToUint(vec4(is_mirrored ? c : b, distances.x)),
			floatBitsToUint(vec4(is_mirrored ? b : c, distances.y)));
}
