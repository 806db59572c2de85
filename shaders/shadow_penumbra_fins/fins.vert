#version 460
// Passes welded vertices unchanged to fins.geom.
layout(location = 0) in vec4 in_position_node;
layout(location = 1) in vec4 in_normal_node;
layout(location = 0) out vec3 out_position_node;
layout(location = 1) out vec3 out_normal_node;
layout(location = 2) flat out uint out_vertex;

void main() {
	out_position_node = in_position_node.xyz;
	out_normal_node = in_normal_node.xyz;
	out_vertex = uint(gl_VertexIndex);
}
