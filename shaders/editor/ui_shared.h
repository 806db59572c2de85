#ifndef UI_SHARED_H
#define UI_SHARED_H
#include "shared/shared_begin.h"

#define UI_BINDING_TEXTURE 0
#define UI_BINDING_SAMPLER 1

/// Push constants of ui.vert.
struct SHARED_ALIGN UiPush {
	vec2 clip_per_px; // clip-space units per pixel: 2 / window size in pixels
	vec2 padding;
};
SHARED_SIZE(UiPush, 16);

#include "shared/shared_end.h"
#endif
