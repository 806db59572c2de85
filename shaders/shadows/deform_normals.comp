#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/work_rows_inc.glsl"
#include "shadows/shadows_shared.h"

// Computes the normals of a deformed mesh's welded vertices: the normalized area-weighted sum of their faces'
// normals, or zero where those cancel, as in build_topology.
layout(local_size_x = DEFORM_GROUP_SIZE) in;
layout(std430, set = 0, binding = MOVE_BINDING_POSITIONS) readonly buffer Positions {
	vec4 welded_positions[];
};
layout(std430, set = 0, binding = MOVE_BINDING_SOURCES) readonly buffer Sources {
	uint faces[]; // index of each vertex's first face, one end index, then the faces
};
layout(std430, set = 0, binding = MOVE_BINDING_TRIANGLES) readonly buffer Triangles {
	uint triangles[];
};
layout(std430, set = 0, binding = MOVE_BINDING_RESULT) writeonly buffer Result {
	vec4 normals[];
};
layout(push_constant) uniform Push {
	DeformPush push;
};

void main() {
	// Normals cancel when their sum is shorter than this fraction of the sum of their lengths, as
	// in topology.cpp (ZERO_NORMAL_RATIO).
	const float ZERO_RATIO = 1e-6;
	const uint vertex = find_work_item(uint(DEFORM_GROUP_SIZE));
	if (vertex >= push.vertex_count) {
		return;
	}
	vec3 sum = vec3(0.0);
	float length_sum = 0.0;
	const uint end = faces[vertex + 1u];
	for (uint i = faces[vertex]; i < end; ++i) {
		const uint first = 3u * faces[i];
		const vec3 a = welded_positions[triangles[first]].xyz;
		const vec3 normal = cross(welded_positions[triangles[first + 1u]].xyz - a,
				welded_positions[triangles[first + 2u]].xyz - a);
		sum += normal;
		length_sum += length(normal); // twice the face's area
	}
	const float size = length(sum);
	normals[vertex] = vec4(size > ZERO_RATIO * length_sum ? sum / size : vec3(0.0), 0.0);
}
