#version 460

// Draws text and gizmos over the image. Positions are in pixels from the top left.
layout(push_constant) uniform Push {
	vec4 clip_per_px; // xy: 2 / image size in pixels; zw: unused
};
layout(location = 0) in vec2 in_position_px;
layout(location = 1) in vec4 in_color;
layout(location = 0) out vec4 out_color;

void main() {
	out_color = in_color;
	gl_Position = vec4(in_position_px * clip_per_px.xy - 1.0, 0.0, 1.0);
}
