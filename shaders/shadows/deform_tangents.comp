#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/work_rows_inc.glsl"
#include "shadows/deform_inc.glsl"

// Computes tangents of a mesh at a pose, one vertex per invocation. w, the sign of the bitangent,
// is copied.
layout(std430, set = 0, binding = DEFORM_BINDING_POSITIONS) readonly buffer Tangents {
	vec4 rest_tangents[];
};
layout(std430, set = 0, binding = DEFORM_BINDING_RESULT) writeonly buffer Result {
	vec4 tangents[];
};

void main() {
	const uint vertex = find_work_item(uint(DEFORM_GROUP_SIZE));
	if (vertex >= push.vertex_count) {
		return;
	}
	const vec4 at_rest = rest_tangents[vertex];
	const vec3 along = add_targets(at_rest.xyz, vertex, DEFORM_TANGENTS);
	const DeformRows rows = blend_joints(vertex);
	const vec3 tangent = vec3(dot(rows.x.xyz, along), dot(rows.y.xyz, along), dot(rows.z.xyz, along));
	// Scaled first, so that the square of the length neither underflows nor overflows.
	const float max_component = max(abs(tangent.x), max(abs(tangent.y), abs(tangent.z)));
	tangents[vertex] = vec4(max_component > 0.0 ? normalize(tangent / max_component) : at_rest.xyz, at_rest.w);
}
