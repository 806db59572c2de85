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
