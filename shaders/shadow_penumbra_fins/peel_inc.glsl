// Depth peeling (Everitt 2001): what is not strictly deeper than the layer before is dropped, and the
// depth test keeps the nearest of the rest. Reversed depth: deeper is smaller, 0 is empty.
#ifndef PEEL_INC_GLSL
#define PEEL_INC_GLSL

#include "shadow_penumbra_fins/shadow_penumbra_fins_shared.h"

layout(set = 0, binding = PEEL_BINDING_NEARER) uniform texture2D nearer_texture;

bool is_deeper_than_nearer_layer() {
	// Depth clamp comes after the shader: compare what the test will store.
	const float depth = clamp(gl_FragCoord.z, 0.0, 1.0);
	return depth < texelFetch(nearer_texture, ivec2(gl_FragCoord.xy), 0).r;
}

#endif
