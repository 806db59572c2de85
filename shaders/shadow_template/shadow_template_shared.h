#ifndef SHADOW_TEMPLATE_SHARED_H
#define SHADOW_TEMPLATE_SHARED_H
#include "shared/shared_begin.h"

#define SHADOW_TEMPLATE_BINDING_FRAME 0
#define SHADOW_TEMPLATE_BINDING_VIEWS 1
#define SHADOW_TEMPLATE_BINDING_DEPTH 2
#define SHADOW_TEMPLATE_BINDING_NORMAL 3
#define SHADOW_TEMPLATE_BINDING_RECEIVERS 4
#define SHADOW_TEMPLATE_BINDING_MAP 5
#define SHADOW_TEMPLATE_BINDING_MASK 6
#define SHADOW_TEMPLATE_GROUP_SIZE 8

/// Push constants of resolve.comp.
struct SHARED_ALIGN ShadowTemplatePush {
	float strength; // 0..1: 1 = hidden is black
	uint padding0;
	uint padding1;
	uint padding2;
};
SHARED_SIZE(ShadowTemplatePush, 16);

#include "shared/shared_end.h"
#endif
