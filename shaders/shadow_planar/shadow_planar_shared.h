#ifndef SHADOW_PLANAR_SHARED_H
#define SHADOW_PLANAR_SHARED_H
#include "shared/shared_begin.h"

// Bindings of lit.frag and plane.frag.
#define PLANAR_BINDING_FRAME 0
#define PLANAR_BINDING_DEPTH 1
#define PLANAR_BINDING_NORMAL 2
#define PLANAR_BINDING_RECEIVERS 3

/// Push constants of plane.frag.
struct SHARED_ALIGN PlanePush {
	vec4 plane;					  // camera-relative: dot(xyz, p) + w = 0
	float tolerance_m;			  // maximum distance from the plane is tolerance_m +
	float tolerance_per_distance; // tolerance_per_distance * distance from the camera
	float padding0;
	float padding1;
};
SHARED_SIZE(PlanePush, 32);

/// Push constants of flatten.vert and flatten.frag: one caster.
struct SHARED_ALIGN FlattenPush {
	mat4 clip_from_node; // projects onto the plane, then to the camera's clip space
	vec4 plane_node;	 // dot(xyz, p) + w is a point's height over the plane in metres
	float max_height_m;	 // height of the light: higher points hide nothing
	float padding0;
	float padding1;
	float padding2;
};
SHARED_SIZE(FlattenPush, 96);

#include "shared/shared_end.h"
#endif
