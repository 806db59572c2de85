// Position of a pixel's receiver, at which techniques test visibility.
#ifndef RECEIVER_INC_GLSL
#define RECEIVER_INC_GLSL

#include "common/depth_inc.glsl"
#include "common/normal_inc.glsl"
#include "shared/light_shared.h"

/// Camera-relative position of a pixel's surface, moved along its normal by RECEIVER_OFFSET * S.
vec3 receiver_position(FrameConstants p_frame, ivec2 p_pixel, float p_depth, vec3 p_normal) {
	return position_from_depth(p_frame, p_pixel, p_depth) +
			p_normal * (RECEIVER_OFFSET * p_frame.scene_size_m);
}

#endif
