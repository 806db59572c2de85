#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/silhouette_inc.glsl"

// Writes one pixel per face, at the face's index: a bit for each edge that the face owns and that is a silhouette.
layout(triangles_adjacency) in;
layout(points, max_vertices = 1) out;
layout(location = 0) in vec3 in_position_node[];
layout(location = 1) flat in uint in_vertex[];
layout(location = 0) flat out uint out_found;
layout(std430, set = 0, binding = 0) readonly buffer FaceFlags {
	uint face_flags[];
};
layout(push_constant) uniform Push {
	vec4 light_position_node; // w 1: position of a point light, w 0: direction to a directional light
	vec4 size_px; // xy: size of the target
};

void main() {
	uint ids[6];
	vec3 positions[6];
	for (int i = 0; i < 6; ++i) {
		ids[i] = in_vertex[i];
		positions[i] = in_position_node[i];
	}
	out_found = find_owned_silhouettes(light_position_node, face_flags[gl_PrimitiveIDIn], ids, positions);
	const uint width = uint(size_px.x);
	const vec2 pixel = vec2(uint(gl_PrimitiveIDIn) % width, uint(gl_PrimitiveIDIn) / width) + 0.5;
	gl_Position = vec4(2.0 * pixel / size_px.xy - 1.0, 0.5, 1.0);
	EmitVertex();
	EndPrimitive();
}
