#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/work_rows_inc.glsl"
#include "shadows/shadows_shared.h"

// Computes the vertices of a mesh that was cut out of a deformed one, from the corners of the triangles that contain
// them.
layout(local_size_x = DEFORM_GROUP_SIZE) in;
layout(std430, set = 0, binding = MOVE_BINDING_POSITIONS) readonly buffer Positions {
	float corner_positions[];
};
layout(std430, set = 0, binding = MOVE_BINDING_SOURCES) readonly buffer Sources {
	DeformPoint points[];
};
layout(std430, set = 0, binding = MOVE_BINDING_RESULT) writeonly buffer Result {
	float positions[];
};
layout(push_constant) uniform Push {
	DeformPush push;
};

vec3 load_corner(uint p_vertex) {
	return vec3(corner_positions[3u * p_vertex], corner_positions[3u * p_vertex + 1u],
			corner_positions[3u * p_vertex + 2u]);
}

void main() {
	const uint vertex = find_work_item(uint(DEFORM_GROUP_SIZE));
	if (vertex >= push.vertex_count) {
		return;
	}
	const DeformPoint point = points[vertex];
	const vec3 a = load_corner(point.corners.x);
	// Relative to one corner: the sum of the rounded weights is only nearly 1, which would move
	// points far from the origin.
	const vec3 position = a + point.weights.y * (load_corner(point.corners.y) - a) +
			point.weights.z * (load_corner(point.corners.z) - a);
	positions[3u * vertex] = position.x;
	positions[3u * vertex + 1u] = position.y;
	positions[3u * vertex + 2u] = position.z;
}
