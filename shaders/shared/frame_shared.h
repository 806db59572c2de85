#ifndef FRAME_SHARED_H
#define FRAME_SHARED_H
#include "shared/shared_begin.h"

/// One frame's camera. Camera-relative space: the world's axes, metres, the camera at the origin.
struct SHARED_ALIGN FrameConstants {
	mat4 clip_from_camera_relative; // reversed depth: near / z, 1 near .. 0 far, far at infinity
	// xyz: camera's right times the tangent of half the horizontal angle; w: a face that is turned away from a light by an angle of at
	// least this sine is a receiver on its far side, see RECEIVER_FAR_SIDE; above 1: none is.
	vec4 right_tangent;
	vec4 up_tangent;	// xyz: camera's up times the tangent of half the vertical angle
	// xyz: unit, plus the camera's shift (CameraSnapshot::shift) along the tangents above, so that
	// the image's centre is along it.
	vec4 forward;
	uvec2 size_px;
	float near_m;
	float scene_size_m;		 // S
	float pixel_size_per_m;	 // width of a pixel, in metres, per metre of distance along the view
	float receiver_offset_m; // see compute_receiver_offset_m
	float receiver_offset_per_m; // of distance along the view
	float max_receiver_offset_m;
};
SHARED_SIZE(FrameConstants, 144);
SHARED_OFFSET(FrameConstants, right_tangent, 64);
SHARED_OFFSET(FrameConstants, size_px, 112);

/// Values of the texture of receivers. A pixel is a receiver on its far side if the light reaches the side of its face that the
/// viewer does not see. Its mask decides about surfaces whose vertex normals face the light though their faces do not, such as
/// grass whose normals point up.
#define RECEIVER_NONE 0.0
#define RECEIVER_FAR_SIDE 0.5
#define RECEIVER_NEAR_SIDE 1.0

/// p_receiver: of a receiver, its value in that texture, which rounds it to 8 bits.
SHARED_FUNCTION bool is_on_far_side(float p_receiver) {
	return p_receiver < 0.5 * (RECEIVER_FAR_SIDE + RECEIVER_NEAR_SIDE);
}

/// How far a receiver is moved along its normal before its visibility is tested, in metres. The
/// reference and all techniques do this, so that all results refer to the same point. Exceptions:
/// planar moves the plane, and the shadow volumes the depth along the view ray. p_distance_m: of
/// the receiver from the camera, along its view. See RECEIVER_OFFSET_PX in camera_view.h.
SHARED_FUNCTION float compute_receiver_offset_m(FrameConstants p_frame, float p_distance_m) {
	return min(p_frame.receiver_offset_m + p_frame.receiver_offset_per_m * p_distance_m,
			p_frame.max_receiver_offset_m);
}

#include "shared/shared_end.h"
#endif
