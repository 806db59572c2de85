// The receiver of one pixel, ready for a technique: camera-relative, moved off its surface.
#ifndef RECEIVER_INC_GLSL
#define RECEIVER_INC_GLSL

#include "common/depth_inc.glsl"
#include "common/normal_inc.glsl"

// P is moved along its normal by this part of S before anything asks what hides it
// (TECHNIQUES, section 0): the reference does the same, so that all answer for one point.
const float RECEIVER_OFFSET = 5e-5;

vec3 receiver_position(FrameConstants p_frame, ivec2 p_pixel, float p_depth, vec3 p_normal) {
	return position_from_depth(p_frame, p_pixel, p_depth) +
			p_normal * (RECEIVER_OFFSET * p_frame.scene_size_m);
}

#endif
