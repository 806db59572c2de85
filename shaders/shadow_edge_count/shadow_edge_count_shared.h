#ifndef SHADOW_EDGE_COUNT_SHARED_H
#define SHADOW_EDGE_COUNT_SHARED_H
#include "shared/map_resolve_shared.h"
#include "shared/shared_begin.h"

// The table of masks, see DiscMasks: by direction, then by offset; one uvec2 each.
#define EDGE_COUNT_DIRECTION_COUNT 256
#define EDGE_COUNT_OFFSET_COUNT 64
#define EDGE_COUNT_SAMPLE_COUNT 64

// Edges and faces are recorded once per light, in light space: metres, the origin at the light's
// centre (directional: at its view's origin), the axes of its first view.

// Of the word that holds a face's index: the rest of its bits.
#define EDGE_COUNT_FACE_MASK 0x00ffffffu
#define EDGE_COUNT_DOUBLE_SIDED 0x80000000u // of a part of a mesh that is not closed
#define EDGE_COUNT_INCONSISTENT 0x40000000u // both faces wind along the edge in one direction
#define EDGE_COUNT_NO_FACE 0xffffffffu

/// An edge that may be a silhouette from some point of the light: 2 x RGBA32_UINT.
struct SHARED_ALIGN CountEdgeRecord {
	uvec4 a_face0; // bits of its position; index and kind of its first face, which winds a -> b
	uvec4 b_face1; // the same of b; index of the second face, or EDGE_COUNT_NO_FACE
};
SHARED_SIZE(CountEdgeRecord, 32);

/// A face: 3 x RGBA32_UINT. Its plane has a buffer of its own, which edges read too.
struct SHARED_ALIGN CountFaceRecord {
	uvec4 a_kind; // bits of the position; 0 or EDGE_COUNT_DOUBLE_SIDED
	uvec4 b;
	uvec4 c;
};
SHARED_SIZE(CountFaceRecord, 48);

/// The bounds of so many edges that follow one another in the light's list: one test may reject all.
struct SHARED_ALIGN CountEdgeBundle {
	vec4 center;
	vec4 half_size;
};
SHARED_SIZE(CountEdgeBundle, 32);
#define EDGE_COUNT_BUNDLE_SIZE 32
// Behind the bundles of a light are the bounds of so many bundles each.
#define EDGE_COUNT_BUNDLES_PER_GROUP 32

// Edges are found 32 to a word, 64 words to a block, so that the list has their own order.
#define EDGE_COUNT_EDGES_PER_WORD 32
#define EDGE_COUNT_WORDS_PER_BLOCK 64

// Bindings of the passes that find faces and edges.
#define FIND_BINDING_POSITIONS 0
#define FIND_BINDING_MESH_FACES 1
#define FIND_BINDING_MESH_EDGES 2
#define FIND_BINDING_PLANES 3
#define FIND_BINDING_FACES 4
#define FIND_BINDING_WORDS 5
#define FIND_BINDING_BLOCKS 6
#define FIND_BINDING_EDGES 7
#define FIND_BINDING_TOTALS 8
#define FIND_BINDING_BUNDLES 9
#define FIND_BINDING_LIGHT 10

/// An edge between welded vertices, a -> b as its first face winds.
struct SHARED_ALIGN CountMeshEdge {
	uint a;
	uint b;
	uint face0; // index and kind
	uint face1; // EDGE_COUNT_NO_FACE at a boundary
};
SHARED_SIZE(CountMeshEdge, 16);

/// A face of welded vertices.
struct SHARED_ALIGN CountMeshFace {
	uint a;
	uint b;
	uint c;
	uint kind; // 0 or EDGE_COUNT_DOUBLE_SIDED
};
SHARED_SIZE(CountMeshFace, 16);

/// One caster, and its first indices in the buffers that all casters of a light share.
struct SHARED_ALIGN CountCasterPush {
	mat4 light_from_node;
	uint face_count;
	uint first_face;
	uint edge_count;
	uint first_word;
	uint first_block;
	uint flags; // a sum of EDGE_COUNT_CASTER_*
	float disc_radius;	  // R in metres; directional: a tangent
	float side_tolerance; // of a face's plane, see count_find_light_side
};
SHARED_SIZE(CountCasterPush, 96);
#define EDGE_COUNT_CASTER_MIRRORED 1u
#define EDGE_COUNT_CASTER_LAST 2u // the last one that has edges
#define EDGE_COUNT_CASTER_DIRECTIONAL 4u

#define EDGE_COUNT_MAX_VIEWS 6
// Pixels are bounded, and share a list of edges, in blocks of 8 x 8; tiles of 2 x 2 blocks find these lists.
#define EDGE_COUNT_BLOCK_PX 8
#define EDGE_COUNT_BLOCKS_PER_TILE_SIDE 2
#define EDGE_COUNT_CONSTANT_GROUP_SIZE 0 // invocations of a subgroup
#define EDGE_COUNT_CONSTANT_VIEW_COUNT 1 // so that one view needs no search
#define EDGE_COUNT_CONSTANT_HAS_NO_LIST 2 // the blocks of the pass read all edges of the light
// The list of a part of a block is a chain of chunks. Behind all chunks is the next one of each.
#define EDGE_COUNT_CHUNK_SIZE 64
// Of each block and part: the first chunk, and how many edges are listed.
#define EDGE_COUNT_CHAIN_FIRST 0
#define EDGE_COUNT_CHAIN_COUNT 1
#define EDGE_COUNT_CHAIN_WORDS 2
#define EDGE_COUNT_NO_BUDGET 0xffffffffu

/// A light view: a map of face lists.
struct SHARED_ALIGN CountViewConstants {
	// The view's x, y and z axes in light space.
	vec4 axis_x;
	vec4 axis_y;
	vec4 axis_z;
	vec2 half_extent; // of the map: x' and y', tangents; directional: metres
	uvec2 map_size_px;
};
SHARED_SIZE(CountViewConstants, 64);

/// One light, and how its buffers are divided.
struct SHARED_ALIGN CountLightConstants {
	CountViewConstants views[EDGE_COUNT_MAX_VIEWS];
	float disc_radius;	 // R in metres; directional: a tangent
	float depth_far_m;	 // directional: w = depth_far_m - z
	float scene_size_m;	 // S
	float nearer_tolerance; // an edge counts only where it is so much nearer to the light: a share of the
							// receiver's distance; directional: metres
	uvec2 block_count; // over the image
	uvec2 tile_count;
	uint is_directional;
	uint view_count;
	uint empty_views; // bit i: view i has no casters or no receivers
	uint chunk_capacity; // of the lists of all blocks
	uint budget;	   // edges that a block may have, or EDGE_COUNT_NO_BUDGET
	uint node_capacity; // of each view's face lists
	uint face_count;
	uint most_edges; // that the light's list may have; 0 where its size is 0
	float interpolation; // of how many R an edge may move between a block's receivers, see EDGE_COUNT_BLOCKS_SMOOTH
	uint most_cut_faces; // that the list of faces that may cut the light's disc may have
	uint most_bundles; // behind so many begin the bounds of groups of them
	uint padding;
};
SHARED_SIZE(CountLightConstants, 464);
SHARED_OFFSET(CountLightConstants, disc_radius, 384);
SHARED_OFFSET(CountLightConstants, block_count, 400);

// The receivers of a block are divided into parts, each with a box of its own. Where all are in one view and are at
// very different distances from the camera, as at an object's outline, they are sorted by that, and each quarter of its
// range is a part: a block is a thin cone of camera rays, so that receivers at like distances are close together in any
// light's view. Else those in view i are part i.
#define EDGE_COUNT_SORTED_PARTS 4
#define EDGE_COUNT_PARTS(view_count) ((view_count) == 1u ? EDGE_COUNT_SORTED_PARTS : EDGE_COUNT_MAX_VIEWS)
/// Receivers of one part: (x', y') is in a rectangle, and w in a range about a plane.
struct SHARED_ALIGN CountBlockBox {
	vec4 least_greatest; // x' and y'
	vec4 slope_range;	 // w per x' and y' of the plane; least and greatest of w - slope.(x', y')
};
SHARED_SIZE(CountBlockBox, 32);

// What a block receives: a sum of 1 << part for each part that is there, of EDGE_COUNT_IS_SORTED and then its view
// from bit EDGE_COUNT_VIEW_SHIFT on, and of EDGE_COUNT_IS_PARTLY_LIT where some receiver is in no part, since no
// caster can hide it; and of EDGE_COUNT_IS_SMOOTH where each pixel has a receiver, all are in one part, and their
// positions change evenly from pixel to pixel. Then, where it is sorted, its pixels in that order, a byte each: the index
// in the order of find_pixel_in_block, and the part.
#define EDGE_COUNT_PARTS_MASK 0x3fu
#define EDGE_COUNT_VIEW_SHIFT 8
#define EDGE_COUNT_VIEW_MASK 7u
#define EDGE_COUNT_IS_SMOOTH 0x20000000u
#define EDGE_COUNT_IS_SORTED 0x40000000u
#define EDGE_COUNT_IS_PARTLY_LIT 0x80000000u
#define EDGE_COUNT_RECEIVES_PARTS 0
#define EDGE_COUNT_RECEIVES_ORDER 1
#define EDGE_COUNT_RECEIVES_WORDS 17
#define EDGE_COUNT_ORDER_PIXEL_MASK 63u
#define EDGE_COUNT_ORDER_PART_SHIFT 6

// What passes count.
#define EDGE_COUNT_TOTAL_EDGES 0
#define EDGE_COUNT_TOTAL_NODES 1 // of each view's face lists, also those without room
#define EDGE_COUNT_TOTAL_LEVELS (EDGE_COUNT_TOTAL_NODES + EDGE_COUNT_MAX_VIEWS) // see load_count_level
#define EDGE_COUNT_TOTAL_CUT_FACES (EDGE_COUNT_TOTAL_LEVELS + EDGE_COUNT_MAX_VIEWS)
#define EDGE_COUNT_TOTAL_COUNT 16

// Bindings of the passes over pixels and blocks, after those of map_resolve_inc.glsl.
#define COUNT_BINDING_LIGHT (MAP_RESOLVE_OWN_BINDING + 0)
#define COUNT_BINDING_BOXES (MAP_RESOLVE_OWN_BINDING + 1)
#define COUNT_BINDING_EDGES (MAP_RESOLVE_OWN_BINDING + 2)
#define COUNT_BINDING_TOTALS (MAP_RESOLVE_OWN_BINDING + 3)
#define COUNT_BINDING_CHAINS (MAP_RESOLVE_OWN_BINDING + 4)
#define COUNT_BINDING_LISTS (MAP_RESOLVE_OWN_BINDING + 5)
#define COUNT_BINDING_HEADS (MAP_RESOLVE_OWN_BINDING + 6)
#define COUNT_BINDING_NODES (MAP_RESOLVE_OWN_BINDING + 7)
#define COUNT_BINDING_FACES (MAP_RESOLVE_OWN_BINDING + 8)
#define COUNT_BINDING_PLANES (MAP_RESOLVE_OWN_BINDING + 9)
#define COUNT_BINDING_MASKS (MAP_RESOLVE_OWN_BINDING + 10)
#define COUNT_BINDING_OUTPUT (MAP_RESOLVE_OWN_BINDING + 11)
#define COUNT_BINDING_BLOCKS (MAP_RESOLVE_OWN_BINDING + 12)
#define COUNT_BINDING_DEPTH_MAP (MAP_RESOLVE_OWN_BINDING + 13)
#define COUNT_BINDING_DISPATCHES (MAP_RESOLVE_OWN_BINDING + 14)
#define COUNT_BINDING_BUNDLES (MAP_RESOLVE_OWN_BINDING + 15)
#define COUNT_BINDING_RECEIVES (MAP_RESOLVE_OWN_BINDING + 16)
#define COUNT_BINDING_CUT_FACES (MAP_RESOLVE_OWN_BINDING + 17)

// Blocks by what they have: neither edges nor faces, so that all receivers are lit, or all dark; no edges; a list
// of edges; edges, but no room for a list; more edges than the budget; a list of edges that are all so far away that
// the mask is smooth, see resolve_smooth.comp. For each kind the arguments of a dispatch
// (blocks, 1, 1) and the blocks. Behind these arguments the number of chunks that were requested, also those
// without room.
#define EDGE_COUNT_BLOCKS_EVEN 0
#define EDGE_COUNT_BLOCKS_PLAIN 1
#define EDGE_COUNT_BLOCKS_LISTED 2
#define EDGE_COUNT_BLOCKS_UNLISTED 3
#define EDGE_COUNT_BLOCKS_FILTERED 4
#define EDGE_COUNT_BLOCKS_SMOOTH 5
#define EDGE_COUNT_BLOCK_KINDS 6
#define EDGE_COUNT_BLOCK_IS_DARK 0x80000000u // with the block, in the list of even ones
#define EDGE_COUNT_DISPATCH_CHUNKS 18
#define EDGE_COUNT_DISPATCH_WORDS 19

// Layers of the debug image.
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

// Bindings of the passes that list the faces of each texel.
#define FACE_LIST_BINDING_LIGHT 0
#define FACE_LIST_BINDING_FACES 1
#define FACE_LIST_BINDING_HEADS 2
#define FACE_LIST_BINDING_NODES 3
#define FACE_LIST_BINDING_TOTALS 4
#define FACE_LIST_BINDING_DISPATCHES 5
#define FACE_LIST_BINDING_CUT_FACES 6
#define FACE_LIST_GROUP_SIZE 64

/// One attempt to list a view's faces.
struct SHARED_ALIGN CountFaceListPush {
	uint view;
	uint is_first; // the map has all its texels
	uint is_last;  // the attempt before the last, which has one texel: there is room in any case
	uint padding;
};
SHARED_SIZE(CountFaceListPush, 16);
// Dispatches of a further attempt: clearing the map, then listing; three words each.
#define FACE_LIST_DISPATCH_CLEAR 0
#define FACE_LIST_DISPATCH_LIST 3
#define FACE_LIST_DISPATCH_WORDS 6

#include "shared/shared_end.h"
#endif
