// Bindings of resolve.comp, cases.comp and hard.comp in addition to those of common/map_resolve_inc.glsl.
#ifndef BINDINGS_INC_GLSL
#define BINDINGS_INC_GLSL

#include "common/map_compare_inc.glsl"
#include "common/map_resolve_inc.glsl"
#include "shadow_penumbra_fins/shadow_penumbra_fins_shared.h"

layout(set = 0, binding = RESOLVE_BINDING_LAYER_1) uniform texture2DArray layer_1_texture;
layout(push_constant) uniform Push {
	FinsResolvePush push;
};

#endif
