#ifndef SHADOW_PCSS_SHARED_H
#define SHADOW_PCSS_SHARED_H
#include "shared/map_resolve_shared.h"
#include "shared/shared_begin.h"

/// Push constants of resolve.comp.
struct SHARED_ALIGN ShadowPcssPush {
	uint empty_views;  // bit i: view i has no casters, its layer was not drawn
	uint tap_count;	   // of each of both steps
	float disc_radius; // R in metres; directional: tangent of half the angular distance
	float padding;
	float nearest_w[8]; // of each view: no caster of it has a greater w, see LightViewConstants
};
SHARED_SIZE(ShadowPcssPush, 48);

#include "shared/shared_end.h"
#endif
