// Morph targets, then linear blend skinning, of one vertex (glTF 2.0, 3.7.2.2 and 3.7.3.3): deform_vertices in float32.
#ifndef DEFORM_INC_GLSL
#define DEFORM_INC_GLSL

#include "shadows/shadows_shared.h"

layout(local_size_x = DEFORM_GROUP_SIZE) in;
layout(std430, set = 0, binding = DEFORM_BINDING_INFLUENCES) readonly buffer Influences {
	uvec2 influences[]; // joint, weight as bits
};
layout(std430, set = 0, binding = DEFORM_BINDING_TARGETS) readonly buffer Targets {
	float target_values[]; // of each target those of positions, of normals, of tangents
};
layout(std430, set = 0, binding = DEFORM_BINDING_POSE) readonly buffer Pose {
	vec4 pose[];
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

/// A vertex's value with what the targets add to values of the kind.
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

/// The weighted sum of the joints' matrices: its rows.
struct DeformRows {
	vec4 x;
	vec4 y;
	vec4 z;
};

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
