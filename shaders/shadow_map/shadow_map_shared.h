#ifndef SHADOW_MAP_SHARED_H
#define SHADOW_MAP_SHARED_H
#include "shared/map_resolve_shared.h"
#include "shared/shared_begin.h"

#define SHADOW_MAP_CONSTANT_FILTER_WIDTH 0 // id of the specialization constant

/// Push constants of resolve.comp and accumulate.comp.
struct SHARED_ALIGN ShadowMapPush {
	uint empty_views; // bit i: view i was not drawn, for lack of casters or receivers
	uint point_index; // accumulate.comp: index of the light point
	uint point_count; // accumulate.comp: number of light points
	uint padding;
};
SHARED_SIZE(ShadowMapPush, 16);

#include "shared/shared_end.h"
#endif
