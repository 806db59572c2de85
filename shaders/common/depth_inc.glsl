// Converts stored camera depth to positions. Depth is reversed: near / z, from 1 at the near plane to 0 at infinity.
#ifndef DEPTH_INC_GLSL
#define DEPTH_INC_GLSL

#include "shared/frame_shared.h"

/// Camera-relative position, in metres, of a pixel's centre. p_depth: its stored depth, above 0.
vec3 position_from_depth(FrameConstants p_frame, ivec2 p_pixel, float p_depth) {
	const vec2 uv = (vec2(p_pixel) + 0.5) / vec2(p_frame.size_px);
	const float z_m = p_frame.near_m / p_depth;
	return z_m *
			(p_frame.forward.xyz + (2.0 * uv.x - 1.0) * p_frame.right_tangent.xyz +
					(1.0 - 2.0 * uv.y) * p_frame.up_tangent.xyz);
}

#endif
