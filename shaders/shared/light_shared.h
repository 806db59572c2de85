#ifndef LIGHT_SHARED_H
#define LIGHT_SHARED_H
#include "shared/shared_begin.h"

#define LIGHT_TYPE_OMNI 0u
#define LIGHT_TYPE_SPOT 1u
#define LIGHT_TYPE_DIRECTIONAL 2u
/// Minimum cosine of the angle between a surface's normal and the direction to the light for the
/// surface to face the light. For light that is more grazing, rounding would decide.
#define LIGHT_MIN_COSINE 1e-5f

/// One light in camera-relative space.
struct SHARED_ALIGN LightConstants {
	vec4 position_radius; // xyz: centre L, 0 for directional; w: R in metres, for directional the
						  // tangent of half the angular distance
	vec4 direction;		  // xyz: unit, the direction in which the light shines; w unused
	vec4 intensity;		  // rgb: cd (omni, spot) or lx (directional); w unused
	float range_m;		  // 0 = unlimited
	float cos_outer;	  // of the spot's outer half angle
	float cos_inner;
	uint type; // LIGHT_TYPE_*
};
SHARED_SIZE(LightConstants, 64);

/// A camera placed at the light. View space: x right, y down, z along the view, metres. Map
/// coordinates: perspective (x/z, y/z) with w = 1/z, orthographic (x, y) with w = far - z: in both
/// w is linear on a plane and grows towards the light. Depth stored in maps is w * depth_scale,
/// 1 near .. 0 far.
struct SHARED_ALIGN LightViewConstants {
	mat4 view_from_camera_relative;
	vec2 half_extent;  // of the map, in map coordinates
	float depth_scale; // near (perspective) or 1 / (far - near) (orthographic)
	float far_m;	   // orthographic only
	uvec2 size_px;
	uint is_orthographic;
	uint layer; // of the map's texture array
};
SHARED_SIZE(LightViewConstants, 96);

/// The views of one light: 1, or 6 for omni and wide spots in the order +x -x +y -y +z -z of the
/// light's own axes.
#define MAX_LIGHT_VIEWS 6
struct SHARED_ALIGN LightViewsConstants {
	LightViewConstants views[MAX_LIGHT_VIEWS];
	mat4 light_from_camera_relative; // to the light's own axes; selects one of six views
	uint view_count;
	uint padding0;
	uint padding1;
	uint padding2;
};
SHARED_SIZE(LightViewsConstants, 656);

#include "shared/shared_end.h"
#endif
