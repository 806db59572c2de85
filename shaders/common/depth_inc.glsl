// Converts stored camera depth to positions. Depth is reversed: near / z, from 1 at the near plane
// to 0 at infinity.
#ifndef DEPTH_INC_GLSL
#define DEPTH_INC_GLSL

#include "shared/frame_shared.h"

/// Distance from the camera, along its view, of a surface with this stored depth (above 0), in
/// metres.
float distance_from_depth(FrameConstants p_frame, float p_depth) {
	return p_frame.near_m / p_depth;
}

/// Camera-relative position, in metres, of a point of the image, in pixels from the top left. p_depth: its stored depth,
/// above 0.
vec3 position_at(FrameConstants p_frame, vec2 p_point_px, float p_depth) {
	const vec2 uv = p_point_px / vec2(p_frame.size_px);
	return distance_from_depth(p_frame, p_depth) *
			(p_frame.forward.xyz + (2.0 * uv.x - 1.0) * p_frame.right_tangent.xyz +
					(1.0 - 2.0 * uv.y) * p_frame.up_tangent.xyz);
}

/// As above, of a pixel's centre.
vec3 position_from_depth(FrameConstants p_frame, ivec2 p_pixel, float p_depth) {
	return position_at(p_frame, vec2(p_pixel) + 0.5, p_depth);
}

#endif
