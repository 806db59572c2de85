#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/silhouette_inc.glsl"
#include "shadow_volume/volume_inc.glsl"

// Draws the caps of a volume without a geometry shader: for each face a near cap and, with HAS_FAR_CAP, a far cap. The
// caps of a back-facing face collapse to a point or, if the face is robust, have the opposite winding.
layout(std430, set = 0, binding = VOLUMES_BINDING_POSITIONS) readonly buffer Positions {
	vec4 positions_node[];
};
layout(std430, set = 0, binding = VOLUMES_BINDING_TRIANGLES) readonly buffer Triangles {
	uint triangles[]; // three vertex indices per face
};

layout(std430, set = 0, binding = VOLUMES_BINDING_FACE_FLAGS) readonly buffer FaceFlags {
	uint face_flags[];
};

void main() {
	const uint per_face = HAS_FAR_CAP ? 6u : 3u;
	const uint index = uint(gl_VertexIndex);
	const uint first = 3u * (index / per_face);
	const uvec3 ids = uvec3(triangles[first], triangles[first + 1u], triangles[first + 2u]);
	const bool is_facing = is_light_facing(push.light_position_node, ids, positions_node[ids.x].xyz,
			positions_node[ids.y].xyz, positions_node[ids.z].xyz);
	const bool is_far = index % per_face >= 3u;
	const bool is_solid = (face_flags[index / per_face] & TOPOLOGY_FACE_NOT_SOLID) == 0u;
	const bool has_volume = is_facing || volume_includes(ROBUST_FACES, is_solid);
	uint corner = has_volume ? index % 3u : 0u;
	if (is_far == is_facing) { // reverses the winding
		corner = (3u - corner) % 3u;
	}
	gl_Position = volume_position_clip(positions_node[ids[corner]].xyz, is_far);
}
