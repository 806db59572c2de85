#ifndef GODOT_ADDON_SHARED_H
#define GODOT_ADDON_SHARED_H
#include "shared/shared_begin.h"

// Size of the table of lights that materials read (see gnomon.gdshaderinc), including its first
// row, which describes the view. The row count is a power of two, because a light's row is the last
// 6 bits of its specular amount.
#define RECEIVER_ROW_COUNT 64
#define RECEIVER_COLUMN_COUNT 4

// Bindings of convert_*depth.frag, merge_depth.frag and show_mask.frag.
#define CONVERT_BINDING_DEPTH 0
#define CONVERT_BINDING_PUBLISHED 1
#define MERGE_BINDING_SCENE 0
#define MERGE_BINDING_DRAWN 1
#define MERGE_BINDING_FULL 2
#define SHOW_BINDING_MASKS 0

// Bindings of scale_depth.frag and scale_masks.comp.
#define SCALE_BINDING_FULL_DEPTH 0
#define SCALE_BINDING_DEPTH 1
#define SCALE_BINDING_MASKS 2
#define SCALE_BINDING_RESULT 3

/// Push constants of convert_*depth.frag.
struct SHARED_ALIGN ConvertDepthPush {
	float offset; // P[2][2] of Godot's projection P, whose depth d is P[3][2] / z - P[2][2]
	float padding0;
	float padding1;
	float padding2;
};
SHARED_SIZE(ConvertDepthPush, 16);

/// Push constants of merge_depth.frag: tolerances as fractions of a surface's depth.
struct SHARED_ALIGN MergeDepthPush {
	float surface_tolerance; // up to it the pixel shows the reduced mesh
	float lod_tolerance;	 // largest difference between a reduced mesh and its full mesh
	float padding0;
	float padding1;
};
SHARED_SIZE(MergeDepthPush, 16);

/// Push constants of scale_depth.frag and scale_masks.comp.
struct SHARED_ALIGN ScalePush {
	vec2 ratio; // pixels of the image that is read per pixel that is written
	vec2 padding;
};
SHARED_SIZE(ScalePush, 16);

/// Push constants of show_mask.frag.
struct SHARED_ALIGN ShowMaskPush {
	uint layer; // layer of the array of masks
	uint padding0;
	uint padding1;
	uint padding2;
};
SHARED_SIZE(ShowMaskPush, 16);

#include "shared/shared_end.h"
#endif
