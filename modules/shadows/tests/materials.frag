#version 460
// surfaces.frag without normals, for devices without gl_PrimitiveID in fragment shaders, and for
// tests in which the host provides none.
layout(push_constant) uniform Push {
	mat4 camera_relative_from_node;
	vec4 material; // x: scatter, y: scatter distance in metres
};

layout(location = 0) out vec4 out_material;

void main() {
	out_material = material;
}
