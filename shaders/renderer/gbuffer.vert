#version 460
#extension GL_GOOGLE_include_directive : require
#include "renderer/renderer_shared.h"
#include "shared/frame_shared.h"

// VARIANT_TEXTURED: for surfaces with textures, vertex colours or an alpha cutoff.
layout(set = 0, binding = GBUFFER_BINDING_FRAME) uniform Frame { // why uniform: gbuffer_inc.glsl
	FrameConstants frame;
};
layout(std430, set = 0, binding = GBUFFER_BINDING_INSTANCES) readonly buffer Instances {
	GBufferInstance instances[];
};

layout(location = 0) in vec3 in_position_node;
layout(location = 1) in vec3 in_normal_node;
layout(location = 0) out vec3 out_normal; // world axes; 0 where the mesh has none
layout(location = 4) flat out uint out_instance;
#ifdef VARIANT_TEXTURED
layout(location = 2) in vec2 in_first_uv;
layout(location = 3) in vec2 in_second_uv;
layout(location = 4) in vec4 in_tangent_node;
layout(location = 5) in vec4 in_color;
layout(location = 1) out vec4 out_uvs;
layout(location = 2) out vec4 out_tangent;
layout(location = 3) out vec4 out_color;
#endif

void main() {
	out_instance = gl_InstanceIndex;
	const mat4 m = instances[gl_InstanceIndex].camera_relative_from_node;
	// The cofactor matrix transforms normals, also if the transform has no inverse. For a mirroring
	// transform it gives the opposite normal.
	const mat3 cofactor =
			mat3(cross(m[1].xyz, m[2].xyz), cross(m[2].xyz, m[0].xyz), cross(m[0].xyz, m[1].xyz));
	const vec3 normal = cofactor * in_normal_node * (instances[gl_InstanceIndex].is_mirrored != 0u ? -1.0 : 1.0);
	const float length2 = dot(normal, normal);
	out_normal = length2 > 0.0 ? normal * inversesqrt(length2) : vec3(0.0);
#ifdef VARIANT_TEXTURED
	out_uvs = vec4(in_first_uv, in_second_uv);
	out_tangent = vec4(mat3(m) * in_tangent_node.xyz, in_tangent_node.w);
	out_color = in_color;
#endif
	gl_Position = frame.clip_from_camera_relative * (m * vec4(in_position_node, 1.0));
}
