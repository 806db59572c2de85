#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "shadow_penumbra_fins/peel_inc.glsl"

// Draws the next depth layer, see peel_inc.glsl.
void main() {
	if (!is_behind_previous_layer()) {
		discard;
	}
}
