#ifndef SHADOW_PCSS_SHARED_H
#define SHADOW_PCSS_SHARED_H
#include "shared/map_resolve_shared.h"
#include "shared/shared_begin.h"

/// Push constants of resolve.comp.
struct SHARED_ALIGN ShadowPcssPush {
	uint empty_views;	// bit i: view i was not drawn, for lack of casters or receivers
	uint tap_count;		// of the blocker search, and of the filter
	float light_radius; // R in metres; directional: tangent of half the angular distance
	float padding;
	float nearest_w[8]; // per view: upper bound of its casters' w, see LightViewConstants; of the
						// 8, which fill the struct's alignment, at most 6 are used
};
SHARED_SIZE(ShadowPcssPush, 48);

#include "shared/shared_end.h"
#endif
