#ifndef SHADOW_EDGE_COUNT_SHARED_H
#define SHADOW_EDGE_COUNT_SHARED_H
#include "shared/map_resolve_shared.h"
#include "shared/shared_begin.h"

// Size of the mask table, see DiscMasks: a mask of EDGE_COUNT_SAMPLE_COUNT points (a uvec2) per
// direction and offset.
#define EDGE_COUNT_DIRECTION_COUNT 128
#define EDGE_COUNT_OFFSET_COUNT 256
#define EDGE_COUNT_SAMPLE_COUNT 64

// Edges and faces are recorded once per light, in light space: metres, the origin at the light's
// centre (directional: at its view's origin), the axes of its first view.

// A face index has 24 bits. The high bits of its word are flags.
#define EDGE_COUNT_FACE_MASK 0x00ffffffu
#define EDGE_COUNT_DOUBLE_SIDED 0x80000000u // the face is in a mesh part that is not closed
#define EDGE_COUNT_INCONSISTENT 0x40000000u // both faces wind along the edge in the same direction
#define EDGE_COUNT_NO_FACE 0xffffffffu

/// An edge that may be a silhouette from some point of the light. Fetched as 2 x RGBA32_UINT.
struct SHARED_ALIGN CountEdgeRecord {
	// Float bits of position a; index and flags of the first face, which winds a -> b.
	uvec4 a_face0;
	// Float bits of position b; index of the second face, or EDGE_COUNT_NO_FACE.
	uvec4 b_face1;
};
SHARED_SIZE(CountEdgeRecord, 32);

/// The vertices of a face. Fetched as 3 x RGBA32_UINT. Planes of faces have a separate buffer,
/// which edges read too. The face and its edges exist only for receivers whose part's distance (see
/// EDGE_COUNT_CHAIN_DISTANCE) is in first_distance <= distance < end_distance: other receivers see
/// another level of detail of the cut-out caster.
struct SHARED_ALIGN CountFaceRecord {
	uvec4 a_kind;			// float bits of the position; 0 or EDGE_COUNT_DOUBLE_SIDED
	uvec4 b_first_distance; // float bits
	uvec4 c_end_distance;	// float bits
};
SHARED_SIZE(CountFaceRecord, 48);

// A node of a texel's face list: the face's index, in the high bits the cells that its bounds
// overlap, and the next node, counted from 1; 0 at the end of the list. A texel has 4 x 4 cells:
// the bits from EDGE_COUNT_NODE_CELLS_SHIFT on are their columns, then their rows.
#define EDGE_COUNT_NODE_CELLS_SHIFT 24
#define EDGE_COUNT_NODE_CELLS_PER_SIDE 4

/// The bounding box of EDGE_COUNT_BUNDLE_SIZE consecutive edges of the light's list, and the range
/// of their distances (see CountFaceRecord). One test may reject them all.
struct SHARED_ALIGN CountEdgeBundle {
	vec4 center_first_distance;
	vec4 half_size_end_distance;
};
SHARED_SIZE(CountEdgeBundle, 32);
#define EDGE_COUNT_BUNDLE_SIZE 16
// The buffer of bundles continues with the bounding boxes of groups of this many bundles.
#define EDGE_COUNT_BUNDLES_PER_GROUP 32

// mark_edges.comp sets one bit per edge, 32 per word, and counts the set bits per block of 64
// words. From these counts list_edges.comp computes each edge's index, so that the list is in the
// casters' order and in mesh order. A caster's edges begin with a new word, but not with a new
// block.
#define EDGE_COUNT_EDGES_PER_WORD 32
#define EDGE_COUNT_WORDS_PER_BLOCK 64

// Bindings of the passes that find faces and edges.
#define FIND_BINDING_POINTS 0
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
#define FIND_BINDING_CASTERS 11
#define FIND_BINDING_GROUPS 12

/// An edge between welded vertices, from a to b in the winding order of its first face.
struct SHARED_ALIGN CountMeshEdge {
	uint a;
	uint b;
	uint face0; // index and flags, see EDGE_COUNT_FACE_MASK
	uint face1; // EDGE_COUNT_NO_FACE at a boundary
};
SHARED_SIZE(CountMeshEdge, 16);

/// A face of welded vertices. Fetched as EDGE_COUNT_MESH_FACE_ITEMS x RGBA32_UINT.
struct SHARED_ALIGN CountMeshFace {
	uint a;
	uint b;
	uint c;
	uint kind; // 0 or EDGE_COUNT_DOUBLE_SIDED; in the low bits the index of its source part: the
			   // part to which it belonged before the alpha test cut holes into the mesh
	// The vertices of the face whose plane it uses, see MeshTopology::plane_faces. All faces of a
	// flat region get the same bits: no point is in front of one and behind another, so that
	// silhouettes are closed without the edges between them.
	uint plane_a;
	uint plane_b;
	uint plane_c;
	uint padding;
};
SHARED_SIZE(CountMeshFace, 32);
#define EDGE_COUNT_MESH_FACE_ITEMS 2

/// One caster. Its first indices are in buffers that all casters of the light share
/// (CountFaceRecord, and words of EDGE_COUNT_EDGES_PER_WORD edges) and in those that all meshes
/// share. Fetched as EDGE_COUNT_CASTER_ITEMS x RGBA32_UINT.
struct SHARED_ALIGN CountCasterRecord {
	mat4 light_from_node;
	uint first_face;
	uint first_word;
	uint edge_count;
	uint flags; // EDGE_COUNT_CASTER_*
	uint first_mesh_face; // its first item
	uint first_mesh_edge;
	uint first_vertex;
	uint first_source_part;
	// EDGE_COUNT_CASTER_LEVEL: half widths of the penumbra at a source part (see CountMeshFace), in
	// metres, from which receivers see this level of detail, and from which they see the next one.
	float first_half_width;
	float end_half_width;
	float scale; // largest stretch of a length by light_from_node
	uint padding;
};
SHARED_SIZE(CountCasterRecord, 112);
#define EDGE_COUNT_CASTER_ITEMS 7

// A work group of the passes over casters has this many consecutive faces or words of the light.
#define FIND_GROUP_SIZE 64

/// One work group: its index among those of all faces or words, and the first and last caster that
/// may have some of them.
struct SHARED_ALIGN CountWorkGroup {
	uint index;
	uint first_caster;
	uint last_caster;
	uint padding;
};
SHARED_SIZE(CountWorkGroup, 16);

/// Push constants of the passes over casters.
struct SHARED_ALIGN CountFindPush {
	uint first_group; // of the dispatch, in the buffer of work groups
	uint group_count;
	uint item_count; // faces or words of all casters
	uint is_directional;
	float disc_radius;	  // R in metres; directional: a tangent
	float side_tolerance; // p_tolerance of count_find_light_side
	uint max_edge_count;  // capacity of the light's list of edges
	uint padding;
};
SHARED_SIZE(CountFindPush, 32);
#define EDGE_COUNT_SOURCE_PART_MASK 0x00ffffffu
#define EDGE_COUNT_CASTER_MIRRORED 1u // light_from_node has a negative determinant
#define EDGE_COUNT_CASTER_LEVEL 2u	  // one of two levels of detail of a cut-out caster

#define EDGE_COUNT_MAX_VIEWS 6
// Each block of 8 x 8 pixels has bounds of its receivers and lists of edges. list_blocks.comp
// processes tiles of 2 x 2 blocks.
#define EDGE_COUNT_BLOCK_PX 8
#define EDGE_COUNT_BLOCKS_PER_TILE_SIDE 2
// Specialization constants.
#define EDGE_COUNT_CONSTANT_SUBGROUP_SIZE 0 // invocations of a subgroup
#define EDGE_COUNT_CONSTANT_VIEW_COUNT                                                             \
	1 // views of the light; with one view, shaders need not search the receiver's
#define EDGE_COUNT_CONSTANT_HAS_NO_LIST 2	 // the blocks of the pass read all edges of the light
#define EDGE_COUNT_CONSTANT_IS_DIRECTIONAL 3 // the light is directional
#define EDGE_COUNT_CONSTANT_GROUP_SIZE                                                             \
	4 // invocations of a work group that is one subgroup, at most EDGE_COUNT_MAX_SUBGROUP
#define EDGE_COUNT_CONSTANT_MAY_CUT_DISC 5 // some caster may come within R of the light's centre
// The edge list of one part of a block is a chain of chunks. After all chunks, the buffer has each
// chunk's next chunk.
#define EDGE_COUNT_CHUNK_SIZE 64
// Words per block and part: the first chunk, the number of listed edges, and float bits of the
// part's distance, which is the least distance of its receivers from the light's centre
// (directional: their least z in light space), in metres.
#define EDGE_COUNT_CHAIN_FIRST 0
#define EDGE_COUNT_CHAIN_COUNT 1
#define EDGE_COUNT_CHAIN_DISTANCE 2
#define EDGE_COUNT_CHAIN_WORDS 3
#define EDGE_COUNT_NO_BUDGET 0xffffffffu

/// A light view. Each texel of its map has a list of faces. (x', y') and w of a point are its
/// coordinates (x, y, z) in the view as x / z, y / z and 1 / z; directional: x, y and
/// depth_far_m - z.
struct SHARED_ALIGN CountViewConstants {
	// The view's x, y and z axes in light space.
	vec4 axis_x;
	vec4 axis_y;
	vec4 axis_z;
	vec2 half_extent; // of the map in x' and y': tangents; directional: metres
	uvec2 map_size_px;
};
SHARED_SIZE(CountViewConstants, 64);

/// Constants of one light, and the sizes of its buffers.
struct SHARED_ALIGN CountLightConstants {
	CountViewConstants views[EDGE_COUNT_MAX_VIEWS];
	float disc_radius;		// R, see CountSettings; directional: a tangent
	float depth_far_m;		// directional: w = depth_far_m - z
	float scene_size_m;		// S, the size of the scene
	float nearer_tolerance; // an edge counts only where it is nearer to the light than the receiver
							// by this fraction of the receiver's distance; directional: by this
							// many metres; less for receivers near the camera, in proportion to
							// compute_receiver_offset_m
	uvec2 block_count;		// columns and rows of blocks in the image
	uint view_count;
	uint empty_views;	 // bit i: view i has no casters or no receivers
	uint chunk_capacity; // chunks for the lists of all blocks together
	uint budget;		 // maximum number of edges of a block, or EDGE_COUNT_NO_BUDGET
	uint node_capacity;	 // of each view's face lists
	uint face_count;
	uint max_edge_count;	 // capacity of the light's list of edges; 0 for a light without size
	float interpolation;	 // maximum distance by which an edge's projection onto the light's disc
							 // moves between receivers of a block of EDGE_COUNT_BLOCKS_SMOOTH, in R
	uint max_cut_face_count; // capacity of the list of faces that may cut the light's disc
	uint max_bundle_count;	 // capacity of bundles; the groups of bundles start at this index
	uint unfinished_slot_count;	 // see EDGE_COUNT_MAX_ITERATIONS
	uint unfinished_round_count; // 0: no subgroup has more iterations
	uint padding0;
	uint padding1;
};
SHARED_SIZE(CountLightConstants, 464);
SHARED_OFFSET(CountLightConstants, disc_radius, 384);
SHARED_OFFSET(CountLightConstants, block_count, 400);

// The receivers of a block are divided into parts, each with its own CountBlockBox. If all
// receivers are in one view and their distances from the camera differ much, as at an object's
// outline, they are sorted by distance, and each quarter of the range of distances is a part: a
// block is a thin cone of camera rays, so receivers at similar distances are close together in any
// light view. Otherwise part i has the receivers in view i.
#define EDGE_COUNT_SORTED_PARTS 4
#define EDGE_COUNT_PARTS(view_count)                                                               \
	((view_count) == 1u ? EDGE_COUNT_SORTED_PARTS : EDGE_COUNT_MAX_VIEWS)
/// Bounds of the receivers of one part: a rectangle of (x', y'), a range of w, and a range of w
/// relative to a plane.
struct SHARED_ALIGN CountBlockBox {
	vec4 min_max;	  // min x', min y', max x', max y'
	vec4 slope_range; // slope: w per x' and y' of the plane; min and max of w - slope.(x', y')
	vec4 w_range;	  // min and max of w; the others are 0
};
SHARED_SIZE(CountBlockBox, 48);

// Words that describe the receivers of a block. Word EDGE_COUNT_RECEIVERS_PARTS has bit i set if
// part i has receivers, and flags. EDGE_COUNT_IS_SORTED: parts are sorted by distance, and the bits
// from EDGE_COUNT_VIEW_SHIFT on are their view. EDGE_COUNT_IS_PARTLY_LIT: some receiver is in no
// part because no caster can hide it. EDGE_COUNT_IS_SMOOTH: each pixel has a receiver, all are in
// one part, and their positions change evenly from pixel to pixel. If sorted, the words from
// EDGE_COUNT_RECEIVERS_ORDER on list the pixels in order, one byte each: the index for
// find_pixel_in_block, and the part.
#define EDGE_COUNT_PARTS_MASK 0x3fu // EDGE_COUNT_MAX_VIEWS bits
#define EDGE_COUNT_VIEW_SHIFT 8
#define EDGE_COUNT_VIEW_MASK 7u
#define EDGE_COUNT_IS_SMOOTH 0x20000000u
#define EDGE_COUNT_IS_SORTED 0x40000000u
#define EDGE_COUNT_IS_PARTLY_LIT 0x80000000u
#define EDGE_COUNT_RECEIVERS_PARTS 0
#define EDGE_COUNT_RECEIVERS_ORDER 1
#define EDGE_COUNT_RECEIVERS_WORDS 17 // 1, and 64 pixels in 16 words
#define EDGE_COUNT_ORDER_PIXEL_MASK 63u
#define EDGE_COUNT_ORDER_PART_SHIFT 6

// Indices in the buffer of totals.
#define EDGE_COUNT_TOTAL_EDGES 0
#define EDGE_COUNT_TOTAL_NODES                                                                     \
	1 // per view: nodes of its face lists, including those that did not fit
#define EDGE_COUNT_TOTAL_LEVELS                                                                    \
	(EDGE_COUNT_TOTAL_NODES + EDGE_COUNT_MAX_VIEWS) // per view, see load_count_level
#define EDGE_COUNT_TOTAL_CUT_FACES (EDGE_COUNT_TOTAL_LEVELS + EDGE_COUNT_MAX_VIEWS)
#define EDGE_COUNT_TOTAL_COUNT 16 // all start at 0

// Bindings of the passes over pixels and blocks, after those of map_resolve_inc.glsl.
#define COUNT_BINDING_LIGHT (MAP_RESOLVE_FIRST_FREE_BINDING + 0)
#define COUNT_BINDING_BOXES (MAP_RESOLVE_FIRST_FREE_BINDING + 1)
#define COUNT_BINDING_EDGES (MAP_RESOLVE_FIRST_FREE_BINDING + 2)
#define COUNT_BINDING_TOTALS (MAP_RESOLVE_FIRST_FREE_BINDING + 3)
#define COUNT_BINDING_CHAINS (MAP_RESOLVE_FIRST_FREE_BINDING + 4)
#define COUNT_BINDING_LISTS (MAP_RESOLVE_FIRST_FREE_BINDING + 5)
#define COUNT_BINDING_HEADS (MAP_RESOLVE_FIRST_FREE_BINDING + 6)
#define COUNT_BINDING_NODES (MAP_RESOLVE_FIRST_FREE_BINDING + 7)
#define COUNT_BINDING_FACES (MAP_RESOLVE_FIRST_FREE_BINDING + 8)
#define COUNT_BINDING_PLANES (MAP_RESOLVE_FIRST_FREE_BINDING + 9)
#define COUNT_BINDING_MASKS (MAP_RESOLVE_FIRST_FREE_BINDING + 10)
#define COUNT_BINDING_OUTPUT (MAP_RESOLVE_FIRST_FREE_BINDING + 11)
#define COUNT_BINDING_BLOCKS (MAP_RESOLVE_FIRST_FREE_BINDING + 12)
#define COUNT_BINDING_DEPTH_MAP (MAP_RESOLVE_FIRST_FREE_BINDING + 13)
#define COUNT_BINDING_DISPATCHES (MAP_RESOLVE_FIRST_FREE_BINDING + 14)
#define COUNT_BINDING_BUNDLES (MAP_RESOLVE_FIRST_FREE_BINDING + 15)
#define COUNT_BINDING_BLOCK_RECEIVERS (MAP_RESOLVE_FIRST_FREE_BINDING + 16)
#define COUNT_BINDING_CUT_FACES (MAP_RESOLVE_FIRST_FREE_BINDING + 17)
#define COUNT_BINDING_STATUS (MAP_RESOLVE_FIRST_FREE_BINDING + 18)
#define COUNT_BINDING_UNFINISHED_COUNTS (MAP_RESOLVE_FIRST_FREE_BINDING + 19)
#define COUNT_BINDING_UNFINISHED_ITEMS (MAP_RESOLVE_FIRST_FREE_BINDING + 20)
#define COUNT_BINDING_UNFINISHED_STATES (MAP_RESOLVE_FIRST_FREE_BINDING + 21)
#define COUNT_BINDING_ROUND (MAP_RESOLVE_FIRST_FREE_BINDING + 22)
#define COUNT_BINDING_NEXT_ROUND (MAP_RESOLVE_FIRST_FREE_BINDING + 23)
#define COUNT_BINDING_NEXT_DISPATCH (MAP_RESOLVE_FIRST_FREE_BINDING + 24)

// Words of the status buffer, which is cleared in each frame and read back after it. The first has
// one bit per kind of fault and pass, EDGE_COUNT_FAULT_* << pass; a pass is a kind of blocks that
// is resolved (EDGE_COUNT_BLOCKS_*), or EDGE_COUNT_PASS_LIST_BLOCKS. The others count the work.
#define EDGE_COUNT_STATUS_FAULTS 0
#define EDGE_COUNT_STATUS_LISTED_EDGES 1 // entries of all lists
#define EDGE_COUNT_STATUS_LONGEST_LIST 2 // entries of a part's list
#define EDGE_COUNT_STATUS_WORDS 4
#define EDGE_COUNT_PASS_LIST_BLOCKS 6
#define EDGE_COUNT_PASS_BITS 8
#define EDGE_COUNT_FAULT_LOOP 0x1u		  // a loop did not reach its end: the driver ended it
#define EDGE_COUNT_FAULT_FACE_LIST 0x100u // a list of faces has no end, or an index out of range
#define EDGE_COUNT_FAULT_EDGE_LIST 0x10000u // the same of a list of edges

// Kinds of blocks. Blocks that are all lit have none, since the mask is cleared to 1. Each kind has a list of its blocks, and the arguments of an indirect dispatch,
// (blocks, 1, 1). After the arguments of all kinds is the number of requested chunks, including
// those that did not fit.
#define EDGE_COUNT_BLOCKS_DARK 0	 // no edges, and no face between receivers: they are all dark
#define EDGE_COUNT_BLOCKS_PLAIN 1	 // no edges
#define EDGE_COUNT_BLOCKS_LISTED 2	 // a list of edges
#define EDGE_COUNT_BLOCKS_UNLISTED 3 // edges, but no complete list
#define EDGE_COUNT_BLOCKS_FILTERED 4 // more edges than the budget
#define EDGE_COUNT_BLOCKS_SMOOTH                                                                   \
	5 // a list of edges so far away that the mask is smooth, see count_smooth_inc.glsl
#define EDGE_COUNT_BLOCK_KINDS 6
#define EDGE_COUNT_DISPATCH_CHUNKS 18 // index: 3 arguments for each of 6 kinds precede it
#define EDGE_COUNT_DISPATCH_WORDS 19

// A subgroup that counts edges stops after about this many iterations. The edges that remain are
// counted in rounds, each a dispatch of its own: a slot has the state of one unfinished subgroup
// between two rounds. If there are more unfinished subgroups than slots, the others wait until a slot
// is free. The last round has no limit.
//
// Without the limit, a dispatch takes as long as the longest list of edges demands, and GPUs whose
// dispatches take seconds are reset. The number is that of a CPU driver: llvmpipe ends every loop
// after an invocation has made 65,535 iterations in all its loops together. The margin is for the
// walk through a list of faces, and for what follows until the next test of the limit.
#define EDGE_COUNT_MAX_ITERATIONS 48000
// Words of the buffer of counts: subgroups that were added, and those of them that were taken out
// after the first round.
#define EDGE_COUNT_UNFINISHED_ADDED 0
#define EDGE_COUNT_UNFINISHED_TAKEN 1
#define EDGE_COUNT_UNFINISHED_COUNTS 2
// An item is a block times 2^EDGE_COUNT_SUBGROUP_BITS, plus the subgroup's index in the block.
#define EDGE_COUNT_SUBGROUP_BITS 4
#define EDGE_COUNT_UNFINISHED_IS_NEW 0x80000000u // flag of an item: nothing is counted yet
// Words of the state of one receiver: those of CountProgress, and of CountState without and with
// its counters, which have 18 words for each 64 points.
#define EDGE_COUNT_STATE_WORDS(sample_set_count) (5 + 18 * (sample_set_count))
// The largest subgroup that is used: a block's number of pixels.
#define EDGE_COUNT_MAX_SUBGROUP 64

// Layers of the debug image.
#define EDGE_COUNT_DEBUG_EDGES 0
#define EDGE_COUNT_DEBUG_SOLIDS 1 // in front of the light's centre, see sum_crossings
#define EDGE_COUNT_DEBUG_BLOCKS 2
#define EDGE_COUNT_DEBUG_LAYERS 3

// Taps of the blocker search, and of the filter, in blocks that exceed the budget.
#define EDGE_COUNT_FILTER_TAPS 64u

/// Push constants of the passes over blocks.
struct SHARED_ALIGN CountBlockPush {
	uint kind;		  // EDGE_COUNT_BLOCKS_*
	uint first_block; // start of that kind's list in the buffer of blocks
	float nearest_w;  // EDGE_COUNT_BLOCKS_FILTERED: upper bound of the casters' w, see
					  // LightViewConstants
	uint round;		  // of the passes that count unfinished subgroups
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

/// One attempt to list a view's faces. For the first attempt's texel size see choose_first_level()
/// in clear_faces.comp.
struct SHARED_ALIGN CountFaceListPush {
	uint view;
	uint first_face; // of a range of faces that the view may see
	uint face_count;
	uint is_first;		// the first attempt
	uint is_next_final; // the next attempt is the final one: its map has one texel, where all faces
						// fit
	uint may_overflow;	// it is not known that the lists fit at the map's full size, map_size_px
	uint padding0;
	uint padding1;
};
SHARED_SIZE(CountFaceListPush, 32);
// Offsets, in words, of the indirect dispatch arguments of a further attempt: to clear the map, and
// to list the faces.
#define FACE_LIST_DISPATCH_CLEAR 0
#define FACE_LIST_DISPATCH_LIST 3
#define FACE_LIST_DISPATCH_WORDS 6

#include "shared/shared_end.h"
#endif
