#version 460
// Passes a welded vertex and its index to silhouette.geom unchanged.
layout(location = 0) in vec4 in_position_node;
layout(location = 0) out vec3 out_position_node;
layout(location = 1) flat out uint out_vertex;

void main() {
	out_position_node = in_position_node.xyz;
	out_vertex = uint(gl_VertexIndex);
}
