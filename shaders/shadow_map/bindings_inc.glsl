// Bindings and push constants that resolve.comp and accumulate.comp have in common: the depth maps of one light.
#ifndef BINDINGS_INC_GLSL
#define BINDINGS_INC_GLSL

#include "common/map_resolve_inc.glsl"
#include "shadow_map/lookup_inc.glsl"
#include "shadow_map/shadow_map_shared.h"

layout(set = 0, binding = DEPTH_MAP_BINDING_MAP) uniform texture2DArray map_texture;
layout(push_constant) uniform Push {
	ShadowMapPush push;
};

#endif
