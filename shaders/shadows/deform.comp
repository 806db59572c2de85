#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/work_rows_inc.glsl"
#include "shadows/deform_inc.glsl"

// Computes positions and normals of a mesh at a pose, one vertex per invocation.
layout(std430, set = 0, binding = DEFORM_BINDING_POSITIONS) readonly buffer Positions {
	float rest_positions[];
};
layout(std430, set = 0, binding = DEFORM_BINDING_NORMALS) readonly buffer Normals {
	float rest_normals[];
};
layout(std430, set = 0, binding = DEFORM_BINDING_RESULT) writeonly buffer Result {
	float positions[];
};
layout(std430, set = 0, binding = DEFORM_BINDING_NORMAL_RESULT) writeonly buffer NormalResult {
	float normals[];
};

void main() {
	const uint vertex = find_work_item(uint(DEFORM_GROUP_SIZE));
	if (vertex >= push.vertex_count) {
		return;
	}
	const uint first = 3u * vertex;
	const vec3 at_rest = vec3(rest_positions[first], rest_positions[first + 1u], rest_positions[first + 2u]);
	const vec3 rest_normal = vec3(rest_normals[first], rest_normals[first + 1u], rest_normals[first + 2u]);
	const vec4 morphed = vec4(add_targets(at_rest, vertex, DEFORM_POSITIONS), 1.0);
	const vec3 morphed_normal = add_targets(rest_normal, vertex, DEFORM_NORMALS);
	const DeformRows rows = blend_joints(vertex);
	positions[first] = dot(rows.x, morphed);
	positions[first + 1u] = dot(rows.y, morphed);
	positions[first + 2u] = dot(rows.z, morphed);
	// Normals are transformed by the cofactor matrix, whose rows are these cross products. Unlike the inverse transpose
	// it exists for singular matrices, too.
	const vec3 normal = vec3(dot(cross(rows.y.xyz, rows.z.xyz), morphed_normal),
			dot(cross(rows.z.xyz, rows.x.xyz), morphed_normal),
			dot(cross(rows.x.xyz, rows.y.xyz), morphed_normal));
	// Scaled first, so that the square of the length neither underflows nor overflows.
	const float max_component = max(abs(normal.x), max(abs(normal.y), abs(normal.z)));
	const vec3 unit = max_component > 0.0 ? normalize(normal / max_component) : rest_normal;
	normals[first] = unit.x;
	normals[first + 1u] = unit.y;
	normals[first + 2u] = unit.z;
}
