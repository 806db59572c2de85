#ifndef SHADOW_JITTERED_PCF_SHARED_H
#define SHADOW_JITTERED_PCF_SHARED_H
#include "shared/map_resolve_shared.h"
#include "shared/shared_begin.h"

#define JITTERED_PCF_BINDING_OFFSETS DEPTH_MAP_FIRST_FREE_BINDING

#define JITTERED_PCF_SETS_PER_SIDE 8 // pixels of one 8 x 8 block have different sets
#define JITTERED_PCF_TAPS_PER_RING 8

/// Push constants of resolve.comp.
struct SHARED_ALIGN JitteredPcfPush {
	uint empty_views; // bit i: view i was not drawn, for lack of casters or receivers
	uint ring_count;
	float radius_uv;	// as a fraction of the map's width
	uint has_early_out; // 0 or 1
};
SHARED_SIZE(JitteredPcfPush, 16);

#include "shared/shared_end.h"
#endif
