#ifndef SHADOW_MAP_SHARED_H
#define SHADOW_MAP_SHARED_H
#include "shared/shared_begin.h"

#define SHADOW_MAP_BINDING_FRAME 0
#define SHADOW_MAP_BINDING_VIEWS 1
#define SHADOW_MAP_BINDING_DEPTH 2
#define SHADOW_MAP_BINDING_NORMAL 3
#define SHADOW_MAP_BINDING_RECEIVERS 4
#define SHADOW_MAP_BINDING_MAP 5
#define SHADOW_MAP_BINDING_MASK 6
#define SHADOW_MAP_CONSTANT_FILTER_WIDTH 0
#define SHADOW_MAP_GROUP_SIZE 8

/// Push constants of resolve.comp and accumulate.comp.
struct SHARED_ALIGN ShadowMapPush {
	uint empty_views; // bit i: view i has no casters, its layer was not drawn
	uint point_index; // accumulate.comp: which light point this is
	uint point_count;
	uint padding;
};
SHARED_SIZE(ShadowMapPush, 16);

#include "shared/shared_end.h"
#endif
