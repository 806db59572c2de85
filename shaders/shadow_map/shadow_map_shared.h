#ifndef SHADOW_MAP_SHARED_H
#define SHADOW_MAP_SHARED_H
#include "shared/map_resolve_shared.h"
#include "shared/shared_begin.h"

#define SHADOW_MAP_CONSTANT_FILTER_WIDTH 0

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
