// Applies morph targets, then linear blend skinning, to one vertex (glTF 2.0, 3.7.2.2 and 3.7.3.3). The CPU version is
// deform_vertices.
#ifndef DEFORM_INC_GLSL
#define DEFORM_INC_GLSL

#include "shadows/shadows_shared.h"

layout(local_size_x = DEFORM_GROUP_SIZE) in;
layout(std430, set = 0, binding = DEFORM_BINDING_INFLUENCES) readonly buffer Influences {
	uvec2 influences[]; // joint, weight as bits
};
layout(std430, set = 0, binding = DEFORM_BINDING_TARGETS) readonly buffer Targets {
	float target_values[]; // displacements, per target: of all positions, all normals, all tangents
};
layout(std430, set = 0, binding = DEFORM_BINDING_POSE) readonly buffer Pose {
	vec4 pose[]; // three matrix rows per joint, then the weights of the morph targets
};
layout(push_constant) uniform Push {
	DeformPush push;
};

const uint DEFORM_POSITIONS = 0u;
const uint DEFORM_NORMALS = 1u;
const uint DEFORM_TANGENTS = 2u;

float load_target_weight(uint p_target) {
	return pose[3u * push.joint_count + p_target / 4u][p_target % 4u];
}

/// Adds the weighted displacements of all morph targets to a vertex's value. p_kind: DEFORM_POSITIONS, _NORMALS or
/// _TANGENTS.
vec3 add_targets(vec3 p_value, uint p_vertex, uint p_kind) {
	vec3 value = p_value;
	for (uint target = 0u; target < push.target_count; ++target) {
		const float weight = load_target_weight(target);
		if (weight != 0.0) {
			const uint first = 3u * ((3u * target + p_kind) * push.vertex_count + p_vertex);
			value += weight * vec3(target_values[first], target_values[first + 1u], target_values[first + 2u]);
		}
	}
	return value;
}

/// Rows of a 3 x 4 matrix.
struct DeformRows {
	vec4 x;
	vec4 y;
	vec4 z;
};

/// Weighted sum of the matrices of the vertex's joints; the identity without a skin.
DeformRows blend_joints(uint p_vertex) {
	if (push.influence_count == 0u || push.joint_count == 0u) {
		return DeformRows(vec4(1, 0, 0, 0), vec4(0, 1, 0, 0), vec4(0, 0, 1, 0));
	}
	DeformRows rows = DeformRows(vec4(0.0), vec4(0.0), vec4(0.0));
	for (uint i = 0u; i < push.influence_count; ++i) {
		const uvec2 influence = influences[p_vertex * push.influence_count + i];
		const float weight = uintBitsToFloat(influence.y);
		const uint row = 3u * influence.x;
		rows.x += weight * pose[row];
		rows.y += weight * pose[row + 1u];
		rows.z += weight * pose[row + 2u];
	}
	return rows;
}

#endif
