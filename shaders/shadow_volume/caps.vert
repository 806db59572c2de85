#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/silhouette_inc.glsl"
#include "shadow_volume/volume_inc.glsl"

// Caps without a geometry shader: per face its near one, then its far one where there are such. Those of a
// back-facing face collapse; where it is robust they wind the other way.
layout(std430, set = 0, binding = VOLUMES_BINDING_POSITIONS) readonly buffer Positions {
	vec4 positions_node[];
};
layout(std430, set = 0, binding = VOLUMES_BINDING_TRIANGLES) readonly buffer Triangles {
	uint triangles[]; // three corners a face
};

layout(std430, set = 0, binding = VOLUMES_BINDING_FACE_FLAGS) readonly buffer FaceFlags {
	uint face_flags[];
};

void main() {
	const uint per_face = HAS_FAR_CAP ? 6u : 3u;
	const uint index = uint(gl_VertexIndex);
	const uint first = 3u * (index / per_face);
	const uvec3 ids = uvec3(triangles[first], triangles[first + 1u], triangles[first + 2u]);
	const bool is_facing = is_light_facing(push.light_node, ids, positions_node[ids.x].xyz,
			positions_node[ids.y].xyz, positions_node[ids.z].xyz);
	const bool is_far = index % per_face >= 3u;
	const bool is_solid = (face_flags[index / per_face] & TOPOLOGY_FACE_NOT_SOLID) == 0u;
	const bool has_volume = is_facing || volume_includes(ROBUST_FACES, is_solid);
	uint corner = has_volume ? index % 3u : 0u;
	if (is_far == is_facing) { // the far cap and a back-facing face wind the other way
		corner = (3u - corner) % 3u;
	}
	gl_Position = volume_position_clip(positions_node[ids[corner]].xyz, is_far);
}
