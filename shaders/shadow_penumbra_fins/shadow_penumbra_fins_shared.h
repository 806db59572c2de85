#ifndef SHADOW_PENUMBRA_FINS_SHARED_H
#define SHADOW_PENUMBRA_FINS_SHARED_H
#include "shared/map_resolve_shared.h"
#include "shared/shared_begin.h"

#define FINS_MAX_LAYERS 3 // depth layers

// peel.frag, peel_flag.frag and layers.frag
#define PEEL_BINDING_PREVIOUS_LAYER 0
#define PEEL_BINDING_FOUND 1
#define LAYERS_BINDING_TEXELS 0

// fins.vert, fins.geom, edge_fins.vert, fins.frag
#define FINS_BINDING_CONSTANTS 0
#define FINS_BINDING_POSITIONS 1
#define FINS_BINDING_NORMALS 2
#define FINS_BINDING_EDGES 3
#define FINS_BINDING_LIST 4
#define FINS_BINDING_FACE_FLAGS 5
#define FINS_BINDING_LAYER_1 6
#define FINS_BINDING_LAYER_2 7

// resolve.comp, cases.comp and hard.comp
#define RESOLVE_BINDING_LAYER_1 (MAP_RESOLVE_FIRST_FREE_BINDING + 0)
#define RESOLVE_BINDING_LAYER_3 (MAP_RESOLVE_FIRST_FREE_BINDING + 1)
#define RESOLVE_BINDING_COLOR (MAP_RESOLVE_FIRST_FREE_BINDING + 2)
#define RESOLVE_BINDING_PENUMBRA_DEPTH (MAP_RESOLVE_FIRST_FREE_BINDING + 3)
#define RESOLVE_BINDING_OUTPUT (MAP_RESOLVE_FIRST_FREE_BINDING + 4)

// Specialization constants
#define FINS_CONSTANT_HAS_OUTER 0
#define FINS_CONSTANT_HAS_INNER 1
#define FINS_CONSTANT_LAYER_COUNT 2
#define FINS_CONSTANT_CURVE 3
#define FINS_CONSTANT_STARTS_DARK 4 // no inner fins: the visibility of outer fins begins at 0
#define LAYERS_CONSTANT_WIDTH_PX 5
#define LAYERS_CONSTANT_TEXEL_COUNT 6 // of one layer

// Values of FINS_CONSTANT_CURVE
#define FINS_CURVE_SINE 0
#define FINS_CURVE_LINEAR 1

/// Uniform buffer of the fin draws of one light view. Lengths in metres.
struct SHARED_ALIGN FinsViewConstants {
	vec2 half_extent;  // of the map, see LightViewConstants
	float depth_scale; // see LightViewConstants
	float view_far_m;  // see LightViewConstants; orthographic only
	uint is_orthographic;
	uint layer;			 // of the texture arrays
	float outer_width_m; // r
	float inner_width_m; // t
	float beta_m;		 // inner fins farther than this behind the first layer are discarded
	float nearest_m;	 // distances of fins are clamped to nearest_m..farthest_m; above 0
	float farthest_m;	 // no fin is farther
	float inner_divisor; // K: depths of inner fins are divided by it, which puts them below all
						 // outer ones
};
SHARED_SIZE(FinsViewConstants, 48);

/// Push constants of the draws: one caster.
struct SHARED_ALIGN FinsPush {
	mat4 view_from_node;
	vec4 light_position_node; // xyz / w: the light's centre; w = 0: xyz is the direction towards it
	uint first_in_list;		  // index of the caster's first edge in the list
	float normal_sign;		  // -1 where the normals point into the solid
	uint padding0;
	uint padding1;
};
SHARED_SIZE(FinsPush, 96);

/// Push constants of resolve.comp, cases.comp and hard.comp.
struct SHARED_ALIGN FinsResolvePush {
	uint empty_views; // bit i: view i has no casters or no receivers: its layers must not be read
	uint padding0;
	uint padding1;
	uint padding2;
};
SHARED_SIZE(FinsResolvePush, 16);

#include "shared/shared_end.h"
#endif
