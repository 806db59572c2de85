// Depth peeling (Everitt 2001): fragments that are not strictly deeper than the previous layer are discarded, and the
// depth test keeps the nearest of the others. Depths are reversed: deeper is smaller, 0 is empty.
#ifndef PEEL_INC_GLSL
#define PEEL_INC_GLSL

#include "shadow_penumbra_fins/shadow_penumbra_fins_shared.h"

layout(set = 0, binding = PEEL_BINDING_PREVIOUS_LAYER) uniform texture2D previous_layer_texture;

bool is_behind_previous_layer() {
	// Depth is clamped after the fragment shader, so clamp here to the value that will be stored.
	const float depth = clamp(gl_FragCoord.z, 0.0, 1.0);
	return depth < texelFetch(previous_layer_texture, ivec2(gl_FragCoord.xy), 0).r;
}

#endif
