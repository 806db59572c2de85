#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/normal_inc.glsl"
#include "renderer/renderer_shared.h"

layout(set = 0, binding = GBUFFER_BINDING_POSITIONS) readonly buffer Positions {
	float positions_node[];
};
layout(set = 0, binding = GBUFFER_BINDING_INDICES) readonly buffer Indices {
	uint indices[];
};
layout(push_constant) uniform Push {
	InstancePush instance;
};

layout(location = 0) in vec3 in_normal;
layout(location = 0) out vec4 out_base_color;
layout(location = 1) out uint out_geometric_normal;
layout(location = 2) out uint out_shading_normal;
layout(location = 3) out vec4 out_material; // see make_surface of brdf_inc.glsl
layout(location = 4) out vec4 out_emissive;

vec3 load_position(uint p_corner) {
	const uint base = 3u * indices[3u * uint(gl_PrimitiveID) + p_corner];
	const vec4 node =
			vec4(positions_node[base], positions_node[base + 1u], positions_node[base + 2u], 1.0);
	return (instance.camera_relative_from_node * node).xyz;
}

void main() {
	// From the triangle's corners, not from derivatives: exact at grazing angles and edges.
	const vec3 a = load_position(0u);
	const vec3 geometric = face_normal_to_viewer(a, load_position(1u), load_position(2u));
	vec3 shading = dot(in_normal, in_normal) > 0.0 ? normalize(in_normal) : geometric;
	shading = dot(shading, geometric) < 0.0 ? -shading : shading;

	out_base_color = vec4(instance.base_color_roughness.rgb, 1.0);
	out_geometric_normal = pack_normal(geometric);
	out_shading_normal = pack_normal(shading);
	out_material = vec4(instance.scatter, instance.scatter_distance_m,
			instance.base_color_roughness.a, instance.emissive_metallic.a);
	out_emissive = vec4(instance.emissive_metallic.rgb, 1.0);
}
