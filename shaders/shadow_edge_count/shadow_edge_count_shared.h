#ifndef SHADOW_EDGE_COUNT_SHARED_H
#define SHADOW_EDGE_COUNT_SHARED_H
#include "shared/map_resolve_shared.h"
#include "shared/shared_begin.h"

// The table of masks, see DiscMasks: by direction, then by offset; one uvec2 each.
#define EDGE_COUNT_DIRECTION_COUNT 256
#define EDGE_COUNT_OFFSET_COUNT 64
#define EDGE_COUNT_SAMPLE_COUNT 64

// The kind of an edge, a sum of these.
#define EDGE_COUNT_HAS_FACE1 1
#define EDGE_COUNT_DOUBLE_SIDED 2

/// An edge that is a silhouette from some point of the light; see CountEdge. First what a receiver
/// always needs, then what tells the sides of its faces.
struct SHARED_ALIGN CountEdgeRecord {
	vec4 a_bx;			  // x', y', w of one end; x' of the other
	vec4 by_bw_weight_kind; // y', w of the other; weight as seen from the light's centre; its kind
	vec4 plane0; // n and d of the first face: n.r + d = 0, above 0 in front
	vec4 plane1; // of the second face, or 0
};
SHARED_SIZE(CountEdgeRecord, 64);

/// What bounds so many edges that follow one another in a view's list: one test may spare all of them.
struct SHARED_ALIGN CountEdgeBundle {
	vec4 least_greatest_xy; // x' and y'
	vec4 greatest_w;		// w, 0, 0, 0
};
SHARED_SIZE(CountEdgeBundle, 32);
#define EDGE_COUNT_BUNDLE_SIZE 32

// Edges are found 32 to a word, 64 words to a block, so that the list has their own order.
#define EDGE_COUNT_EDGES_PER_WORD 32
#define EDGE_COUNT_WORDS_PER_BLOCK 64
#define EDGE_COUNT_NO_FACE 0xffffffffu

// Bindings of the passes that find edges.
#define FIND_BINDING_VIEW 0
#define FIND_BINDING_POSITIONS 1
#define FIND_BINDING_FACES 2
#define FIND_BINDING_PLANES 3
#define FIND_BINDING_EDGES 4
#define FIND_BINDING_WORDS 5
#define FIND_BINDING_BLOCKS 6
#define FIND_BINDING_LIST 7
#define FIND_BINDING_TOTALS 8
#define FIND_BINDING_BUNDLES 9

/// An edge between welded vertices, a -> b as its first face winds.
struct SHARED_ALIGN CountMeshEdge {
	uint a;
	uint b;
	uint face0;
	uint face1; // EDGE_COUNT_NO_FACE at a boundary
};
SHARED_SIZE(CountMeshEdge, 16);

/// One caster in a light view. Where its faces and edges stand in the buffers that all share.
struct SHARED_ALIGN CountCasterPush {
	mat4 view_from_node;
	uint face_count;
	uint first_face;
	uint edge_count;
	uint first_word;
	uint first_block;
	uint inconsistent_from; // edges from this one on: both faces wind a -> b
	uint kind;				// a sum of EDGE_COUNT_DOUBLE_SIDED, _MIRRORED and, for the last, _LAST
	uint record_capacity;
};
SHARED_SIZE(CountCasterPush, 96);
#define EDGE_COUNT_MIRRORED 4
#define EDGE_COUNT_LAST_CASTER 8

/// A light view for counting; see CountSpace.
struct SHARED_ALIGN CountViewConstants {
	float disc_radius; // R in metres; directional: a tangent
	float depth_scale_m; // directional: what tolerances are shares of
	float depth_far_m;	 // directional: w = depth_far_m - z
	float scene_size_m;	 // S
	vec2 half_extent;	 // of the layer map, x' and y'
	uvec2 map_size_px;
	uint is_directional;
	float near_m; // what is nearer to the light's plane is cut off; not for directional
	uint index;	  // of the view; its part of the light's buffers
	float least_slope; // z per |x| or |y| below which edges are cut off, likewise
};
SHARED_SIZE(CountViewConstants, 48);
SHARED_OFFSET(CountViewConstants, half_extent, 16);

// Pixels are dealt with in groups of 8 x 8, and groups in square blocks that share a list of edges.
#define EDGE_COUNT_GROUP_PX 8
#define EDGE_COUNT_MAX_VIEWS 6
#define EDGE_COUNT_CONSTANT_GROUP_SIZE 0 // invocations of a subgroup
#define EDGE_COUNT_CONSTANT_VIEW_COUNT 1 // so that one view needs no search
// In place of a list's end: the block has more edges than a list holds.
#define EDGE_COUNT_OVER_BUDGET 0xffffffffu
#define EDGE_COUNT_ENDS_PER_BLOCK 8 // one per view; the rest are unused

/// All views of one light, and how its buffers are divided.
struct SHARED_ALIGN CountLightConstants {
	CountViewConstants views[EDGE_COUNT_MAX_VIEWS];
	uvec2 group_count; // over the picture
	uvec2 block_count;
	uint groups_per_block_side;
	uint view_count;
	uint empty_views;		// bit i: view i has no casters
	uint record_capacity;	// edges of one view
	uint fragment_capacity; // of one view's layer map
	uint list_capacity;		// edges of one block
	uint bundle_capacity;	// of one view
	uint padding;
};
SHARED_SIZE(CountLightConstants, 336);

/// Receivers of one group in one view: least and greatest x', y', w. Empty where a least is greater.
/// Where they lie at very different depths, as beside an object's outline, they are two boxes: what is
/// between them has no receiver.
struct SHARED_ALIGN CountGroupBox {
	uint least_xy; // 16 bits each, see count_boxes_inc.glsl
	uint greatest_xy;
	float least_w;
	float greatest_w;
};
SHARED_SIZE(CountGroupBox, 16);
#define EDGE_COUNT_BOX_NEAR 0 // to the light; all of them, where there is one box
#define EDGE_COUNT_BOX_FAR 1
#define EDGE_COUNT_BOXES_PER_GROUP 2 // and view

// How many records and fragments the views have, also beyond the capacity.
#define EDGE_COUNT_TOTAL_RECORDS 0
#define EDGE_COUNT_TOTAL_FRAGMENTS EDGE_COUNT_MAX_VIEWS
#define EDGE_COUNT_TOTAL_COUNT (2 * EDGE_COUNT_MAX_VIEWS)

// Bindings of the passes over pixels and blocks, after those of map_resolve_inc.glsl.
#define COUNT_BINDING_LIGHT (MAP_RESOLVE_OWN_BINDING + 0)
#define COUNT_BINDING_BOXES (MAP_RESOLVE_OWN_BINDING + 1)
#define COUNT_BINDING_RECORDS (MAP_RESOLVE_OWN_BINDING + 2)
#define COUNT_BINDING_TOTALS (MAP_RESOLVE_OWN_BINDING + 3)
#define COUNT_BINDING_ENDS (MAP_RESOLVE_OWN_BINDING + 4)
#define COUNT_BINDING_LISTS (MAP_RESOLVE_OWN_BINDING + 5)
#define COUNT_BINDING_TEXELS (MAP_RESOLVE_OWN_BINDING + 6)
#define COUNT_BINDING_FRAGMENTS (MAP_RESOLVE_OWN_BINDING + 7)
#define COUNT_BINDING_MASKS (MAP_RESOLVE_OWN_BINDING + 8)
#define COUNT_BINDING_OUTPUT (MAP_RESOLVE_OWN_BINDING + 9)
#define COUNT_BINDING_BLOCKS (MAP_RESOLVE_OWN_BINDING + 10)
#define COUNT_BINDING_MAP (MAP_RESOLVE_OWN_BINDING + 11)
#define COUNT_BINDING_DISPATCHES (MAP_RESOLVE_OWN_BINDING + 12)
#define COUNT_BINDING_BUNDLES (MAP_RESOLVE_OWN_BINDING + 13)

// Blocks are dealt with by what they have: no edges, edges, or more than a list holds. For each kind the
// arguments of a dispatch (blocks, groups of a block, 1) and the blocks; then the arguments of the pass
// that makes the filter's map.
#define EDGE_COUNT_BLOCKS_PLAIN 0
#define EDGE_COUNT_BLOCKS_COUNTED 1
#define EDGE_COUNT_BLOCKS_FILTERED 2
#define EDGE_COUNT_BLOCK_KINDS 3
#define EDGE_COUNT_DISPATCH_MAP 9 // place of its arguments
#define EDGE_COUNT_DISPATCH_WORDS 12

// Layers of the debug picture.
#define EDGE_COUNT_DEBUG_EDGES 0
#define EDGE_COUNT_DEBUG_SOLIDS 1
#define EDGE_COUNT_DEBUG_BLOCKS 2
#define EDGE_COUNT_DEBUG_LAYERS 3

// Taps of each of the filter's two steps.
#define EDGE_COUNT_FILTER_TAPS 64u

/// Push constants of the passes over blocks.
struct SHARED_ALIGN CountBlockPush {
	uint kind;		  // EDGE_COUNT_BLOCKS_*
	uint first_block; // of that kind, in the list of blocks
	float nearest_w;  // the filter: no caster has a greater w, see LightViewConstants
	uint padding;
};
SHARED_SIZE(CountBlockPush, 16);

// The layer map's texels are added up by work groups; each of their invocations has several.
#define LAYERS_GROUP_SIZE 64
#define LAYERS_TEXELS_PER_INVOCATION 16
#define LAYERS_TEXELS_PER_GROUP (LAYERS_GROUP_SIZE * LAYERS_TEXELS_PER_INVOCATION)
// A fragment is one word: the bits of its w, the lowest two replaced by what it is.
#define LAYERS_KIND_MASK 3u
#define LAYERS_TOWARD 0u
#define LAYERS_AWAY 1u
#define LAYERS_DOUBLE_SIDED 2u
// In a texel's count.
#define LAYERS_BURIED 0x80000000u
#define LAYERS_ONLY_AWAY 0x40000000u // faces turned towards the light are not there
#define LAYERS_ONLY_NEAREST 0x20000000u // the buffer has no room for all of them
#define LAYERS_COUNT_MASK 0x1fffffffu
#define LAYERS_CONSTANT_COUNT 0 // fragments of a texel of the cheap map

// Bindings of the passes that make the layer map.
#define LAYERS_BINDING_VIEW 0
#define LAYERS_BINDING_PLANES 1
#define LAYERS_BINDING_COUNTS 2
#define LAYERS_BINDING_SUMS 3
#define LAYERS_BINDING_TEXELS 4
#define LAYERS_BINDING_FRAGMENTS 5
#define LAYERS_BINDING_TOTALS 6
#define LAYERS_BINDING_RECORDS 7

/// One caster drawn into the layer map.
struct SHARED_ALIGN CountLayersPush {
	mat4 clip_from_node;
	uint first_face;
	uint kind; // a sum of EDGE_COUNT_DOUBLE_SIDED and EDGE_COUNT_MIRRORED
	uint fragment_capacity;
	uint padding;
};
SHARED_SIZE(CountLayersPush, 80);

/// A pass over one view's part of the light's buffers.
struct SHARED_ALIGN CountPartPush {
	uint fragment_capacity;
	uint record_capacity;
	uint padding0;
	uint padding1;
};
SHARED_SIZE(CountPartPush, 16);

#include "shared/shared_end.h"
#endif
