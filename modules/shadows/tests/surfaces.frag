#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/normal_inc.glsl"

// Writes the materials and geometric normals of the minimal host in surface_host.h.
layout(set = 0, binding = 1) readonly buffer Positions {
	float positions_node[];
};
layout(set = 0, binding = 2) readonly buffer Indices {
	uint indices[];
};
layout(push_constant) uniform Push {
	mat4 camera_relative_from_node;
	vec4 material; // x: scatter, y: scatter distance in metres
};

layout(location = 0) out vec4 out_material;
layout(location = 1) out uint out_normal;

vec3 load_position(uint p_corner) {
	const uint base = 3u * indices[3u * uint(gl_PrimitiveID) + p_corner];
	return (camera_relative_from_node *
			vec4(positions_node[base], positions_node[base + 1u], positions_node[base + 2u], 1.0)).xyz;
}

void main() {
	out_normal = pack_normal(face_normal_to_viewer(load_position(0u), load_position(1u), load_position(2u)));
	out_material = material;
}
