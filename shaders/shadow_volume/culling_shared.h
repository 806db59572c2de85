#ifndef CULLING_SHARED_H
#define CULLING_SHARED_H
#include "shared/shared_begin.h"

// Occlusion culling in the light's view: occluders.vert, occluders.frag, occluder_edges.vert,
// bounds.comp, cull.comp.

// The occluder map of a view: for each texel a reversed depth at which every ray through the texel
// has met an occluder, that is the smallest (farthest) of the rays' first hits or less. A box that
// is wholly behind it is hidden. Each further level is 4 times as coarse. The texels of all levels,
// the depth pyramid, are called bounds.
#define CULLING_MAP_SIZE_PX 256
#define CULLING_LEVEL_FACTOR 4
#define CULLING_LEVEL_COUNT 4		  // 256, 64, 16, 4
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

// One workgroup of cull.comp tests one subtree of the hierarchy of the casters' boxes
// (culling_boxes.h), and the subtree's casters.
#define CULLING_CASTERS_PER_SUBTREE 64
// The words are the result of cull.comp: a header, then one uint per caster, 0 if it is hidden and
// 1 if not. The header is key_low and key_high, which identify the tested views and casters.
#define CULLING_HEADER_WORDS 2

/// Push constants of occluders.vert, occluders.frag and occluder_edges.vert: one occluder in one
/// view.
struct SHARED_ALIGN OccluderPush {
	mat4 clip_from_node;
	vec4 light_position_node; // xyz / w: the light's centre; w = 0: xyz is the direction towards it
	float near_m;			  // near plane of the view; 0: orthographic
	float padding0;
	float padding1;
	float padding2;
};
SHARED_SIZE(OccluderPush, 96);

/// Push constants of bounds.comp.
struct SHARED_ALIGN BoundsPush {
	uint view_index;
	uint level; // to build, 1..CULLING_LEVEL_COUNT - 1
	uint padding0;
	uint padding1;
};
SHARED_SIZE(BoundsPush, 16);

/// One of the light's views.
struct SHARED_ALIGN CullingView {
	mat4 view_from_relative; // from metres along the world's axes, relative to view 0's position
	vec2 half_extent;		 // tangents; orthographic: metres
	float near_m;
	float far_m;
	uint is_orthographic;
	uint padding0;
	uint padding1;
	uint padding2;
};
SHARED_SIZE(CullingView, 96);

/// Constants of cull.comp.
struct SHARED_ALIGN CullingConstants {
	CullingView views[CULLING_MAX_VIEWS];
	uint view_count;
	uint subtree_count;
	uint key_low; // copied to the header of the words
	uint key_high;
};
SHARED_SIZE(CullingConstants, 592);

/// Bounding box of a subtree of casters or of one caster, in metres along the world's axes,
/// relative to the origin of CullingView::view_from_relative.
struct SHARED_ALIGN CullingBox {
	vec4 center_m;		// xyz
	vec4 half_extent_m; // xyz
	uint first; // subtree: index of its first caster's box; caster: index of its word after the
				// header
	uint count; // subtree: number of its casters; caster: 1
	uint padding0;
	uint padding1;
};
SHARED_SIZE(CullingBox, 48);

#include "shared/shared_end.h"
#endif
