#version 460
#extension GL_GOOGLE_include_directive : require
#include "renderer/renderer_shared.h"
#include "shared/frame_shared.h"

layout(set = 0, binding = GBUFFER_BINDING_FRAME) uniform Frame {
	FrameConstants frame;
};
layout(push_constant) uniform Push {
	InstancePush instance;
};

layout(location = 0) in vec3 in_position_node;
layout(location = 1) in vec3 in_normal_node;
layout(location = 0) out vec3 out_normal;

void main() {
	const mat4 m = instance.camera_relative_from_node;
	// The cofactor matrix carries normals through any linear transform, mirrored ones included.
	const mat3 cofactor = mat3(cross(m[1].xyz, m[2].xyz), cross(m[2].xyz, m[0].xyz),
			cross(m[0].xyz, m[1].xyz));
	const vec3 normal = cofactor * in_normal_node * (instance.is_mirrored != 0u ? -1.0 : 1.0);
	const float length2 = dot(normal, normal);
	out_normal = length2 > 0.0 ? normal * inversesqrt(length2) : vec3(0.0);
	gl_Position = frame.clip_from_camera_relative * (m * vec4(in_position_node, 1.0));
}
