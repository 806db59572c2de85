#ifndef RENDERER_SHARED_H
#define RENDERER_SHARED_H
#include "shared/shared_begin.h"

// Bindings of the renderer's compute passes (receivers, lighting, tone map, debug view).
#define RENDERER_BINDING_FRAME 0
#define RENDERER_BINDING_LIGHT 1
#define RENDERER_BINDING_DEPTH 2
#define RENDERER_BINDING_GEOMETRIC_NORMAL 3
#define RENDERER_BINDING_SHADING_NORMAL 4
#define RENDERER_BINDING_MATERIAL 5
#define RENDERER_BINDING_BASE_COLOR 6
#define RENDERER_BINDING_EMISSIVE 7
#define RENDERER_BINDING_RECEIVERS 8
#define RENDERER_BINDING_MASK 9
#define RENDERER_BINDING_RADIANCE 10
#define RENDERER_BINDING_OUTPUT 11
#define RENDERER_BINDING_TRUTH 12
#define RENDERER_GROUP_SIZE 8
#define RENDERER_CONSTANT_IS_COLORED 0 // 1: the mask has three colours

// Bindings of tint.comp.
#define TINT_BINDING_OPAQUE 0 // the mask of the opaque casters
#define TINT_BINDING_BOTH 1	  // of them and the group
#define TINT_BINDING_BEFORE 2 // as coloured so far
#define TINT_BINDING_RESULT 3

/// Push constants of tint.comp.
struct SHARED_ALIGN TintPush {
	vec4 transmittance; // rgb
};
SHARED_SIZE(TintPush, 16);

/// Push constants of debug_view.comp.
struct SHARED_ALIGN DebugViewPush {
	vec2 shown_range; // value shown black, value shown white
	uint layer;
	uint class_count; // above 0: values are classes 0 .. class_count - 1, shown in colours
	uint is_color;	  // 1: values are colours
	uint padding0;
	uint padding1;
	uint padding2;
};
SHARED_SIZE(DebugViewPush, 32);

#include "shared/shared_end.h"
#endif
