#ifndef SHADOW_EDGE_COUNT_SHARED_H
#define SHADOW_EDGE_COUNT_SHARED_H
#include "shared/shared_begin.h"

// The table of masks, see DiscMasks: by direction, then by offset; one uvec2 each.
#define EDGE_COUNT_DIRECTION_COUNT 256
#define EDGE_COUNT_OFFSET_COUNT 64
#define EDGE_COUNT_SAMPLE_COUNT 64

// CountEdgeRecord.normal1_kind.w, a sum of these.
#define EDGE_COUNT_HAS_FACE1 1
#define EDGE_COUNT_DOUBLE_SIDED 2

/// An edge that is a silhouette from some point of the light; see CountEdge. In the order in which
/// the resolve needs it.
struct SHARED_ALIGN CountEdgeRecord {
	vec4 a_bx;			  // x', y', w of one end; x' of the other
	vec4 by_bw_d0_d1;	  // y', w of the other; distances of the faces' planes from the origin
	vec4 normal0_weight;  // xyz: n of the first face; w: weight as seen from the light's centre
	vec4 normal1_kind;	  // xyz: n of the second face; w: EDGE_COUNT_HAS_FACE1, _DOUBLE_SIDED
};
SHARED_SIZE(CountEdgeRecord, 64);

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
	uint kind;				// a sum of EDGE_COUNT_DOUBLE_SIDED and EDGE_COUNT_MIRRORED
	uint padding;
};
SHARED_SIZE(CountCasterPush, 96);
#define EDGE_COUNT_MIRRORED 4

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
	uint padding1;
	uint padding2;
};
SHARED_SIZE(CountViewConstants, 48);
SHARED_OFFSET(CountViewConstants, half_extent, 16);

#include "shared/shared_end.h"
#endif
