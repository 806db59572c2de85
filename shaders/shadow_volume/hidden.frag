#version 460
// Drawn where the stencil counts a volume.
layout(location = 0) out float out_visibility;

void main() {
	out_visibility = 0.0;
}
