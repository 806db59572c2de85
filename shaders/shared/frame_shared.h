#ifndef FRAME_SHARED_H
#define FRAME_SHARED_H
#include "shared/shared_begin.h"

/// One frame's camera. Camera-relative space: the world's axes, metres, the camera at the origin.
struct SHARED_ALIGN FrameConstants {
	mat4 clip_from_camera_relative; // reversed depth: near / z, 1 near .. 0 far, far at infinity
	vec4 right_tangent; // xyz: camera's right times the tangent of half the horizontal angle
	vec4 up_tangent;	// xyz: camera's up times the tangent of half the vertical angle
	vec4 forward;		// xyz: unit
	uvec2 size_px;
	float near_m;
	float scene_size_m; // S
	vec4 ambient;		// rgb: radiance that every surface reflects; a: exposure
};
SHARED_SIZE(FrameConstants, 144);
SHARED_OFFSET(FrameConstants, right_tangent, 64);
SHARED_OFFSET(FrameConstants, size_px, 112);

/// Push constants of gbuffer.vert and gbuffer.frag.
struct SHARED_ALIGN InstancePush {
	mat4 camera_relative_from_node;
	vec4 base_color_roughness; // rgb linear; a: -1 - roughness for Phong's model
	vec4 emissive_metallic;	   // rgb in cd/m^2
	float scatter;			   // s in 0..1
	float scatter_distance_m;
	uint is_mirrored; // 1: the transform turns the winding round
	uint padding;
};
SHARED_SIZE(InstancePush, 112);

/// Push constants of depth.vert.
struct SHARED_ALIGN DepthPush {
	mat4 clip_from_node;
};
SHARED_SIZE(DepthPush, 64);

#define GBUFFER_BINDING_FRAME 0
#define GBUFFER_BINDING_POSITIONS 1
#define GBUFFER_BINDING_INDICES 2

#include "shared/shared_end.h"
#endif
