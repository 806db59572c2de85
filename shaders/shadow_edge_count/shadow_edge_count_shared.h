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
#define EDGE_COUNT_EDGE_BITS 26 // of an edge's index

/// An edge that may be a silhouette from some point of the light. Fetched as 2 x RGBA32_UINT.
struct SHARED_ALIGN CountEdgeRecord {
	// Float bits of position a; index and flags of the first face, which winds a -> b.
	uvec4 a_face0;
	// Float bits of position b; index of the second face, or EDGE_COUNT_NO_FACE.
	uvec4 b_face1;
};
SHARED_SIZE(CountEdgeRecord, 32);

/// The vertices of a face. Fetched as 3 x RGBA32_UINT. Planes of faces have a separate buffer,
/// which edges read too. The face and its edges exist only for receivers whose leaf's distance is
/// in first_distance <= distance < end_distance: other receivers see another LOD of the cut-out
/// caster.
struct SHARED_ALIGN CountFaceRecord {
	uvec4 a_kind;			// float bits of the position; 0 or EDGE_COUNT_DOUBLE_SIDED
	uvec4 b_first_distance; // float bits
	uvec4 c_end_distance;	// float bits
};
SHARED_SIZE(CountFaceRecord, 48);

/// A node of a tree over a light's faces, or of one over its edges: the bounding box of what is in it, and the range
/// of their distances (see CountFaceRecord). Fetched as 2 x RGBA32_SFLOAT.
///
/// Level 0 of a tree has clusters: EDGE_COUNT_CLUSTER_SIZE consecutive faces or edges of the light. A node of level
/// i + 1 has EDGE_COUNT_NODE_WIDTH consecutive nodes of level i, up to the level that has so few nodes. Casters, and
/// what a mesh has, are in the order of a Hilbert curve, so consecutive ones are close together. There are no pointers:
/// children follow from the index (Karras 2012, Maximizing Parallelism in the Construction of BVHs, section 2, builds
/// trees over such an order).
struct SHARED_ALIGN CountNode {
	vec4 center_first_distance;
	vec4 half_size_end_distance;
};
SHARED_SIZE(CountNode, 32);
#define EDGE_COUNT_CLUSTER_SIZE 16
#define EDGE_COUNT_NODE_WIDTH 8
// Levels of a tree: 16 * 8 * 8^6 is more than 10 million, so the highest level has at most 8 nodes.
#define EDGE_COUNT_MAX_LEVELS 7

// mark_edges.comp sets one bit per edge, 32 per word, and counts the set bits per run of 64
// words. From these counts list_edges.comp computes each edge's index, so that the list is in the
// casters' order and in mesh order. A caster's edges begin with a new word, but not with a new
// run.
#define EDGE_COUNT_EDGES_PER_WORD 32
#define EDGE_COUNT_WORDS_PER_RUN 64

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
	// EDGE_COUNT_CASTER_LOD: half widths of the penumbra at a source part (see CountMeshFace), in
	// metres, from which receivers see this LOD, and from which they see the next one.
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
#define EDGE_COUNT_CASTER_LOD 2u	  // one of two LODs (levels of detail) of a cut-out caster

// Each block of 8 x 8 pixels has leaves: groups of its receivers.
#define EDGE_COUNT_BLOCK_PX 8
// Specialization constants.
#define EDGE_COUNT_CONSTANT_SUBGROUP_SIZE 0 // invocations of a subgroup
#define EDGE_COUNT_CONSTANT_SAMPLE_SETS 1 // sets of 64 points of the light: 1 or 4
#define EDGE_COUNT_CONSTANT_HAS_NO_LIST 2	 // the leaves of the pass read the tree of edges
#define EDGE_COUNT_CONSTANT_IS_DIRECTIONAL 3 // the light is directional
#define EDGE_COUNT_CONSTANT_GROUP_SIZE 4 // invocations of a work group of the passes that count edges
#define EDGE_COUNT_CONSTANT_MAY_CUT_DISC 5 // some caster may come within R of the light's centre
// The device is a CPU: passes that count edges have the shape that suits it. Masks are equal bit for bit.
#define EDGE_COUNT_CONSTANT_IS_CPU 6
#define EDGE_COUNT_CONSTANT_HAS_RUNGS 7 // the light has a time budget, see EDGE_COUNT_RUNG_FULL
#define EDGE_COUNT_CONSTANT_IS_SMOOTH 8 // the leaves of the pass are smooth, see EDGE_COUNT_LEAVES_SMOOTH
#define EDGE_COUNT_CONSTANT_FIRST_LEVEL 9 // the lowest level that bound_nodes.comp writes
#define EDGE_COUNT_NO_BUDGET 0xffffffffu

/// Constants of one light, and the sizes of its buffers.
struct SHARED_ALIGN CountLightConstants {
	// Index of the first node of each level, in the buffer of nodes: levels 0..3, and 4..7.
	uvec4 face_levels[2];
	uvec4 edge_levels[2];
	float disc_radius;		// R, see CountSettings; directional: a tangent
	float depth_far_m;		// directional: w = depth_far_m - z
	float nearer_tolerance; // an edge counts only where it is nearer to the light than the receiver
							// by this fraction of the receiver's distance; directional: by this
							// many metres; less for receivers near the camera, in proportion to
							// compute_receiver_offset_m
	float interpolation;	// maximum distance by which an edge's projection onto the light's disc
							// moves between receivers of a leaf of EDGE_COUNT_LEAVES_SMOOTH, in R
	uvec2 block_count;		// columns and rows of blocks in the image
	uint empty_views;		// bit i: view i has no casters or no receivers
	uint leaf_capacity;
	uint list_capacity; // words of the lists of all leaves together
	uint budget;		// maximum number of listed edges of a leaf, or EDGE_COUNT_NO_BUDGET
	uint face_count;
	uint max_edge_count;		 // capacity of the light's list of edges
	uint max_cut_face_count;	 // capacity of the list of faces that may cut the light's disc
	uint unfinished_slot_count;	 // see EDGE_COUNT_MAX_ITERATIONS
	uint unfinished_round_count; // 0: no subgroup has more iterations
	uint chunk_count; // dispatches into which the leaves of a kind are divided, see CountLeafPush
};
SHARED_SIZE(CountLightConstants, 128);
SHARED_OFFSET(CountLightConstants, disc_radius, 64);
SHARED_OFFSET(CountLightConstants, block_count, 80);

/// A leaf: the receivers of a block whose distances from the camera are in one slice. A block is a thin cone of camera
/// rays, so they are close together (Olsson, Billeter and Assarsson 2012, Clustered Deferred and Forward Shading,
/// section 3.1: tiles with logarithmic slices of depth). Written by find_leaves.comp.
///
/// A leaf has a frame of its own: three axes (see make_count_frame) in which (x', y') and w of a point of light space
/// are x / z, y / z and 1 / z; directional: x, y and depth_far_m - z.
struct SHARED_ALIGN CountLeaf {
	// The frame's z axis in light space; the distance by which all its receivers choose LODs: the
	// least of their distances from the light's centre in metres (directional: their least z in
	// light space).
	vec4 axis_distance;
	vec4 min_max;		// of (x', y'): min x', min y', max x', max y'
	vec4 slope_range;	// slope: w per x' and y' of a plane near the receivers; min and max of w - slope.(x', y')
	vec4 anchor_block;	// position of its anchor, see CountLeafResult; bits of its block's index
	vec4 minimum_w;		// bounds of the receivers in light space; min of w
	vec4 maximum_w;		// the same; max of w
	// Bits of the words: pixels of the block (2 words), see find_pixel_in_block; EDGE_COUNT_LEAF_* flags; 0.
	uvec4 pixels_flags;
};
SHARED_SIZE(CountLeaf, 112);
#define EDGE_COUNT_LEAF_IS_SMOOTH 1u // all pixels of the block have receivers, whose positions change evenly
// Some receiver sees the light so far from the frame's axis that the leaf has no bounds: it needs everything.
#define EDGE_COUNT_LEAF_IS_WIDE 2u
#define EDGE_COUNT_MAX_SLICES 8 // leaves of a block

// Maximum lengths of a leaf's lists of silhouettes and of local faces. Where they are longer, needs_rays is set.
#define EDGE_COUNT_MAX_SILHOUETTES 1024
#define EDGE_COUNT_MAX_LOCAL_FACES 512

/// What list_leaves.comp found for a leaf. Its words in the buffer of lists are indices of silhouette edges as seen
/// from the light's centre, then of local faces, then entries of edges (see COUNT_EDGE_MASK).
///
/// The numbers of faces that the way from a receiver to the light's centre crosses are counted at one receiver, the
/// anchor. See count_sweep_inc.glsl for the others.
struct SHARED_ALIGN CountLeafResult {
	uint first_word;
	uint silhouette_count;
	uint face_count;
	uint edge_count;
	int back_facing; // of the anchor, see count_crossings_inc.glsl
	int light_facing;
	int double_sided;
	uint needs_rays; // 1: the lists of silhouettes and faces are not complete; each receiver walks the tree of faces
};
SHARED_SIZE(CountLeafResult, 32);

// Indices in the buffer of totals.
#define EDGE_COUNT_TOTAL_EDGES 0
#define EDGE_COUNT_TOTAL_CUT_FACES 1
#define EDGE_COUNT_TOTAL_COUNT 4 // all start at 0

// Bindings of the passes over pixels and leaves, after those of map_resolve_inc.glsl.
#define COUNT_BINDING_LIGHT (MAP_RESOLVE_FIRST_FREE_BINDING + 0)
#define COUNT_BINDING_LEAVES (MAP_RESOLVE_FIRST_FREE_BINDING + 1)
#define COUNT_BINDING_EDGES (MAP_RESOLVE_FIRST_FREE_BINDING + 2)
#define COUNT_BINDING_TOTALS (MAP_RESOLVE_FIRST_FREE_BINDING + 3)
#define COUNT_BINDING_RESULTS (MAP_RESOLVE_FIRST_FREE_BINDING + 4)
#define COUNT_BINDING_LISTS (MAP_RESOLVE_FIRST_FREE_BINDING + 5)
#define COUNT_BINDING_NODES (MAP_RESOLVE_FIRST_FREE_BINDING + 6)
#define COUNT_BINDING_FACES (MAP_RESOLVE_FIRST_FREE_BINDING + 7)
#define COUNT_BINDING_PLANES (MAP_RESOLVE_FIRST_FREE_BINDING + 8)
#define COUNT_BINDING_MASKS (MAP_RESOLVE_FIRST_FREE_BINDING + 9)
#define COUNT_BINDING_OUTPUT (MAP_RESOLVE_FIRST_FREE_BINDING + 10)
#define COUNT_BINDING_KINDS (MAP_RESOLVE_FIRST_FREE_BINDING + 11)
#define COUNT_BINDING_DEPTH_MAP (MAP_RESOLVE_FIRST_FREE_BINDING + 12)
#define COUNT_BINDING_COUNTS (MAP_RESOLVE_FIRST_FREE_BINDING + 13)
#define COUNT_BINDING_CUT_FACES (MAP_RESOLVE_FIRST_FREE_BINDING + 14)
#define COUNT_BINDING_STATUS (MAP_RESOLVE_FIRST_FREE_BINDING + 15)
#define COUNT_BINDING_UNFINISHED_COUNTS (MAP_RESOLVE_FIRST_FREE_BINDING + 16)
#define COUNT_BINDING_UNFINISHED_ITEMS (MAP_RESOLVE_FIRST_FREE_BINDING + 17)
#define COUNT_BINDING_UNFINISHED_STATES (MAP_RESOLVE_FIRST_FREE_BINDING + 18)
#define COUNT_BINDING_ROUND (MAP_RESOLVE_FIRST_FREE_BINDING + 19)
#define COUNT_BINDING_NEXT_ROUND (MAP_RESOLVE_FIRST_FREE_BINDING + 20)
#define COUNT_BINDING_NEXT_DISPATCH (MAP_RESOLVE_FIRST_FREE_BINDING + 21)
#define COUNT_BINDING_ARGUMENTS (MAP_RESOLVE_FIRST_FREE_BINDING + 22)
#define COUNT_BINDING_LADDER (MAP_RESOLVE_FIRST_FREE_BINDING + 23) // one word, cached between frames

// The other bindings of the passes that find faces and edges.
#define FIND_BINDING_POINTS (MAP_RESOLVE_FIRST_FREE_BINDING + 24)
#define FIND_BINDING_MESH_FACES (MAP_RESOLVE_FIRST_FREE_BINDING + 25)
#define FIND_BINDING_MESH_EDGES (MAP_RESOLVE_FIRST_FREE_BINDING + 26)
#define FIND_BINDING_WORDS (MAP_RESOLVE_FIRST_FREE_BINDING + 27)
#define FIND_BINDING_RUNS (MAP_RESOLVE_FIRST_FREE_BINDING + 28)
#define FIND_BINDING_CASTERS (MAP_RESOLVE_FIRST_FREE_BINDING + 29)
#define FIND_BINDING_GROUPS (MAP_RESOLVE_FIRST_FREE_BINDING + 30)

// A light with a time budget lowers its most expensive leaves, one rung after the other, until the expected time of all is
// within the budget. The cost of a leaf is the mean over its block's pixels of the listed edges plus
// EDGE_COUNT_COST_OF_RECEIVER: a measure of time that does not depend on scheduling. Its class is its base 2 logarithm,
// rounded down. A leaf's rung depends on its class and one number for the whole light, the position of its
// ladder, which choose_rungs.comp finds from the sums of each class's costs.
#define EDGE_COUNT_RUNG_FULL 0
#define EDGE_COUNT_RUNG_FEW_POINTS 1 // 64 points of the light
#define EDGE_COUNT_RUNG_FEW_PIXELS 2 // and of 2 x 2 pixels one is counted
#define EDGE_COUNT_RUNG_FILTERED 3
#define EDGE_COUNT_RUNG_COUNT 4
// As many edges as the rest of a receiver's work takes time, and the cost of a filtered leaf. Measured on a CPU.
#define EDGE_COUNT_COST_OF_RECEIVER 32
#define EDGE_COUNT_COST_OF_FILTER 80
#define EDGE_COUNT_COST_CLASSES 26
#define EDGE_COUNT_FIRST_LOWERED_CLASS 7 // leaves below it take about the time of the filter
// The highest class has leaves that cannot be on a rung between the first and the last: without lists, or with so many
// edges that they are counted in rounds (EDGE_COUNT_MAX_ITERATIONS).
#define EDGE_COUNT_COST_EXTREME (EDGE_COUNT_COST_CLASSES - 1)
#define EDGE_COUNT_NO_COST_LIMIT 0xffffffffu

// A word of the lists of leaves by kind: the leaf's index, and above it the class of its cost.
#define EDGE_COUNT_KIND_LEAF_BITS 27

// Words of the status buffer, which is cleared in each frame and read back after it. The first has
// one bit per kind of fault and pass, EDGE_COUNT_FAULT_* << pass; a pass is a kind of leaves that
// is resolved (EDGE_COUNT_LEAVES_*), or EDGE_COUNT_PASS_LIST_LEAVES. The others count the work.
#define EDGE_COUNT_STATUS_FAULTS 0
#define EDGE_COUNT_STATUS_LISTED_EDGES 1 // entries of all lists
#define EDGE_COUNT_STATUS_LONGEST_LIST 2 // entries of a leaf's list
#define EDGE_COUNT_STATUS_RAYS 3 // receivers whose solids were counted along their own ray
#define EDGE_COUNT_STATUS_LEAVES 4 // all leaves
#define EDGE_COUNT_STATUS_LONGEST_WALK 5 // iterations of a subgroup that lists a leaf
#define EDGE_COUNT_STATUS_LONGEST_COUNT 6 // of one that counts edges, in a dispatch
#define EDGE_COUNT_STATUS_COST 7 // with a time budget: cost of all leaves on their rungs
#define EDGE_COUNT_STATUS_RUNGS 8 // with a time budget: number of leaves on each rung
#define EDGE_COUNT_STATUS_WORDS (EDGE_COUNT_STATUS_RUNGS + EDGE_COUNT_RUNG_COUNT)
#define EDGE_COUNT_PASS_LIST_LEAVES 6
#define EDGE_COUNT_FAULT_LOOP 0x1u	   // a loop did not reach its end: the driver ended it
#define EDGE_COUNT_FAULT_TREE 0x100u   // a walk through a tree has no end
#define EDGE_COUNT_FAULT_LIST 0x10000u // a list has an index out of range

// Kinds of leaves. Leaves that are all lit have none, since the mask is cleared to 1. Each kind has a list of its
// leaves.
#define EDGE_COUNT_LEAVES_DARK 0	 // nothing changes between its receivers: they are all dark
#define EDGE_COUNT_LEAVES_PLAIN 1	 // no edges: each receiver sees the whole light or nothing of it
#define EDGE_COUNT_LEAVES_LISTED 2	 // a list of edges
#define EDGE_COUNT_LEAVES_UNLISTED 3 // no list
#define EDGE_COUNT_LEAVES_FILTERED 4 // more edges than the budget
// A list of edges so far away that the mask is smooth, see resolve_few_pixels.comp.
#define EDGE_COUNT_LEAVES_SMOOTH 5
#define EDGE_COUNT_LEAF_KINDS 6
#define EDGE_COUNT_FEW_PIXELS 16 // that are counted in a smooth leaf, and on EDGE_COUNT_RUNG_FEW_PIXELS
// The arguments of the indirect dispatches over leaves: one for each kind, and a buffer of its own
// with one for all leaves. They have rows of EDGE_COUNT_GROUPS_PER_ROW work groups.
#define EDGE_COUNT_ARGUMENT_WORDS 3
// With a time budget, after those of all kinds: those of a kind's leaves on one rung, which are 0 if no leaf is on it. Of
// smooth leaves, those on EDGE_COUNT_RUNG_FEW_POINTS include those on the next rung, which are counted in the same way.
#define EDGE_COUNT_RUNG_ARGUMENTS(rung, kind) (EDGE_COUNT_LEAF_KINDS * (1 + (rung)) + (kind))
#define EDGE_COUNT_ARGUMENT_COUNT (EDGE_COUNT_LEAF_KINDS * (1 + EDGE_COUNT_RUNG_COUNT))
#define EDGE_COUNT_GROUPS_PER_ROW 64
// The buffer of counts: the leaves of each kind, all leaves, leaves beyond the first of their block, and words of all
// lists. The last two include what did not fit.
#define EDGE_COUNT_COUNT_ALL EDGE_COUNT_LEAF_KINDS
#define EDGE_COUNT_COUNT_MORE (EDGE_COUNT_LEAF_KINDS + 1)
#define EDGE_COUNT_COUNT_LIST_WORDS (EDGE_COUNT_LEAF_KINDS + 2)
// With a time budget, for each class: the sum of its leaves' costs, and their number. Then the position of the ladder, and
// above it CountRungsPush::first_rung.
#define EDGE_COUNT_FIRST_RUNG_SHIFT 16
#define EDGE_COUNT_COUNT_COSTS (EDGE_COUNT_LEAF_KINDS + 3)
#define EDGE_COUNT_COUNT_COST_LEAVES (EDGE_COUNT_COUNT_COSTS + EDGE_COUNT_COST_CLASSES)
#define EDGE_COUNT_COUNT_LADDER (EDGE_COUNT_COUNT_COST_LEAVES + EDGE_COUNT_COST_CLASSES)
#define EDGE_COUNT_COUNT_WORDS (EDGE_COUNT_COUNT_LADDER + 1)

// A subgroup that counts edges stops after about this many iterations. The edges that remain are
// counted in rounds, each a dispatch of its own: a slot has the state of one unfinished subgroup
// between two rounds. If there are more unfinished subgroups than slots, the others wait until a slot
// is free. The last round has no limit.
//
// Without the limit, a dispatch takes as long as the longest list of edges demands, and GPUs whose
// dispatches take seconds are reset. The number is that of a CPU driver: llvmpipe ends every loop
// after an invocation has made 65,535 iterations in all its loops together. The margin is for
// the numbers of solids, and for what follows until the next test of the limit.
#define EDGE_COUNT_MAX_ITERATIONS 48000
// Words of the buffer of counts: subgroups that were added, and those of them that were taken out
// after the first round.
#define EDGE_COUNT_UNFINISHED_ADDED 0
#define EDGE_COUNT_UNFINISHED_TAKEN 1
#define EDGE_COUNT_UNFINISHED_COUNTS 2
// An item is a leaf times 2^EDGE_COUNT_SUBGROUP_BITS, plus the subgroup's index in the leaf.
#define EDGE_COUNT_SUBGROUP_BITS 6
#define EDGE_COUNT_UNFINISHED_IS_NEW 0x80000000u // flag of an item: nothing is counted yet
// Words of the state of one invocation, see SavedCount in resolve_unfinished.comp.
#define EDGE_COUNT_STATE_WORDS(sample_set_count) (22 * (sample_set_count))
// The largest subgroup that is used: a leaf's number of pixels.
#define EDGE_COUNT_MAX_SUBGROUP 64

// Layers of the debug image.
#define EDGE_COUNT_DEBUG_EDGES 0
#define EDGE_COUNT_DEBUG_SOLIDS 1 // in front of the light's centre, see sum_crossings
#define EDGE_COUNT_DEBUG_LEAVES 2
#define EDGE_COUNT_DEBUG_LAYERS 3

// Taps of the blocker search, and of the filter, in leaves that exceed the budget.
#define EDGE_COUNT_FILTER_TAPS 64u

/// Push constants of the passes over leaves.
struct SHARED_ALIGN CountLeafPush {
	uint kind;		  // EDGE_COUNT_LEAVES_*
	uint first_leaf;  // start of that kind's list in the buffer of kinds
	float nearest_w;  // EDGE_COUNT_LEAVES_FILTERED: upper bound of the casters' w, see
					  // LightViewConstants
	uint round;		  // of the passes that count unfinished subgroups
	// The leaves with an index of chunk + i * CountLightConstants::chunk_count in the kind's list. Several dispatches,
	// without barriers between them, take the same time, but none takes so long that a GPU does nothing else.
	uint chunk;
	uint rungs; // bit i: resolves leaves on rung i
	uint padding0;
	uint padding1;
};
SHARED_SIZE(CountLeafPush, 32);

/// Push constants of choose_rungs.comp.
struct SHARED_ALIGN CountRungsPush {
	uint cost_limit; // the cost for which there is time
	uint first_rung; // the ladder begins below it: on those above leaves cost the same
	float few_points_share; // the cost of a leaf on EDGE_COUNT_RUNG_FEW_POINTS, of that on the first rung
	uint padding;
};
SHARED_SIZE(CountRungsPush, 16);

#include "shared/shared_end.h"
#endif
