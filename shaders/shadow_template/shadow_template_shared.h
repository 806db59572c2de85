#ifndef SHADOW_TEMPLATE_SHARED_H
#define SHADOW_TEMPLATE_SHARED_H
#include "shared/map_resolve_shared.h"
#include "shared/shared_begin.h"

/// Push constants of resolve.comp.
struct SHARED_ALIGN ShadowTemplatePush {
	float strength; // 0..1: how dark hidden points are; 1 = no light
	uint padding0;
	uint padding1;
	uint padding2;
};
SHARED_SIZE(ShadowTemplatePush, 16);

#include "shared/shared_end.h"
#endif
