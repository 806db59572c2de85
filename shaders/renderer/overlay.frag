#version 460

// Draws text and gizmos with the colours of their vertices; the pipeline blends them.
layout(location = 0) in vec4 in_color;
layout(location = 0) out vec4 out_color;

void main() {
	out_color = in_color;
}
