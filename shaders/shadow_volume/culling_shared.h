#ifndef CULLING_SHARED_H
#define CULLING_SHARED_H
#include "shared/shared_begin.h"

// Occlusion culling in the light's view: occluders.vert, occluder_edges.vert, bounds.comp, cull.comp.

// The map of a view: for each texel the least reversed depth (the farthest) at which every ray of the
// texel has met an occluder. Each further level is 4 times as coarse.
#define CULLING_MAP_SIZE_PX 256
#define CULLING_LEVEL_FACTOR 4
#define CULLING_LEVEL_COUNT 4 // 256, 64, 16, 4
#define CULLING_BOUNDS_PER_VIEW 69904 // texels of all levels
#define CULLING_MAX_VIEWS 6

#define CULLING_BINDING_POSITIONS 0
#define CULLING_BINDING_TRIANGLES 1
#define CULLING_BINDING_EDGES 2
#define CULLING_BINDING_DEPTH 3
#define CULLING_BINDING_BOUNDS 4
#define CULLING_BINDING_CONSTANTS 5
#define CULLING_BINDING_BOXES 6
#define CULLING_BINDING_WORDS 7

// One workgroup of cull.comp looks at one subtree and its casters.
#define CULLING_CASTERS_PER_SUBTREE 64
// Before the casters' words: whose result it is.
#define CULLING_HEADER_WORDS 2

/// Push constants of occluders.vert, occluders.frag and occluder_edges.vert: one occluder in one view.
struct SHARED_ALIGN OccluderPush {
	mat4 clip_from_node;
	vec4 light_node; // xyz / w: the light's centre; w = 0: the direction towards it
	float near_m;	 // of the view; 0: orthographic
	float padding0;
	float padding1;
	float padding2;
};
SHARED_SIZE(OccluderPush, 96);

/// Push constants of bounds.comp.
struct SHARED_ALIGN BoundsPush {
	uint view_index;
	uint level; // that is made, from 1
	uint padding0;
	uint padding1;
};
SHARED_SIZE(BoundsPush, 16);

struct SHARED_ALIGN CullingView {
	mat4 view_from_relative; // from metres along the world's axes, relative to the view's position
	vec2 half_extent;		 // tangents; orthographic: metres
	float near_m;
	float far_m;
	uint is_orthographic;
	uint padding0;
	uint padding1;
	uint padding2;
};
SHARED_SIZE(CullingView, 96);

/// Uniform buffer of cull.comp.
struct SHARED_ALIGN CullingConstants {
	CullingView views[CULLING_MAX_VIEWS];
	uint view_count;
	uint subtree_count;
	uint key_low; // goes into the header
	uint key_high;
};
SHARED_SIZE(CullingConstants, 592);

/// A box round a subtree of casters, or round one. Relative as CullingView.
struct SHARED_ALIGN CullingBox {
	vec4 center_m;		// xyz
	vec4 half_extent_m; // xyz
	uint first;			// subtree: its first caster's box; caster: its index among the words
	uint count;			// subtree: of its casters
	uint padding0;
	uint padding1;
};
SHARED_SIZE(CullingBox, 48);

#include "shared/shared_end.h"
#endif
