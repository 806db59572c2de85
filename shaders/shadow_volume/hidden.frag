#version 460
// Writes shadow into the mask; drawn where the stencil count is not 0.
layout(location = 0) out float out_visibility;

void main() {
	out_visibility = 0.0;
}
