#version 460
// For the tests of the device: passes the triangle through; its neighbours are the odd vertices.
layout(triangles_adjacency) in;
layout(triangle_strip, max_vertices = 3) out;
layout(location = 0) in vec4 color[];
layout(location = 0) out vec4 out_color;

void main() {
	for (int corner = 0; corner < 6; corner += 2) {
		out_color = color[corner];
		gl_Position = gl_in[corner].gl_Position;
		EmitVertex();
	}
}
