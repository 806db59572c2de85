#ifndef FRAME_SHARED_H
#define FRAME_SHARED_H
#include "shared/shared_begin.h"

/// One frame's camera. Camera-relative space: the world's axes, metres, the camera at the origin.
struct SHARED_ALIGN FrameConstants {
	mat4 clip_from_camera_relative; // reversed depth: near / z, 1 near .. 0 far, far at infinity
	vec4 right_tangent; // xyz: camera's right times the tangent of half the horizontal angle
	vec4 up_tangent;	// xyz: camera's up times the tangent of half the vertical angle
	// xyz: unit, plus the camera's shift (CameraSnapshot::shift) along the tangents above, so that
	// the image's centre is along it.
	vec4 forward;
	uvec2 size_px;
	float near_m;
	float scene_size_m; // S
};
SHARED_SIZE(FrameConstants, 128);
SHARED_OFFSET(FrameConstants, right_tangent, 64);
SHARED_OFFSET(FrameConstants, size_px, 112);

#include "shared/shared_end.h"
#endif
