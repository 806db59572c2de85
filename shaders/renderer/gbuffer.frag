#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/normal_inc.glsl"
#include "renderer/gbuffer_inc.glsl"

// Writes the surface at each pixel to the G-buffer, see GBuffer in gbuffer.h.
layout(set = 0, binding = GBUFFER_BINDING_POSITIONS) readonly buffer Positions {
	float positions_node[];
};
layout(set = 0, binding = GBUFFER_BINDING_INDICES) readonly buffer Indices {
	uint indices[];
};
layout(std430, set = 0, binding = GBUFFER_BINDING_INSTANCES) readonly buffer Instances {
	GBufferInstance instances[];
};

layout(location = 0) in vec3 in_normal; // world axes; 0 where the mesh has none
layout(location = 4) flat in uint in_instance;
layout(location = 0) out vec4 out_base_color;
layout(location = 1) out uint out_shading_normal;
layout(location = 2) out vec4 out_material;
layout(location = 3) out vec4 out_emissive;
layout(location = 4) out uint out_geometric_normal;

vec3 load_position(uint p_corner) {
	const uint base = 3u * indices[3u * uint(gl_PrimitiveID) + p_corner];
	const vec4 node =
			vec4(positions_node[base], positions_node[base + 1u], positions_node[base + 2u], 1.0);
	return (instances[in_instance].camera_relative_from_node * node).xyz;
}

void main() {
	// From the triangle's corners, not from derivatives: exact at grazing angles and edges.
	const vec3 a = load_position(0u);
	const vec3 geometric = face_normal_to_viewer(a, load_position(1u), load_position(2u));

	const SurfaceTexels texels = make_texels(instances[in_instance], make_shading_normal(in_normal, geometric));
	out_base_color = texels.base_color;
	out_shading_normal = pack_normal(texels.shading_normal);
	out_material = texels.material;
	out_emissive = vec4(texels.emissive, 1.0);
	out_geometric_normal = pack_normal(geometric);
}
