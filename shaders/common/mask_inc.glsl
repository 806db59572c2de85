// Visibility masks have one channel, or three where translucent casters colour the light.
#ifndef MASK_INC_GLSL
#define MASK_INC_GLSL

#include "shared/mask_shared.h"

/// Luminance of a coloured mask. Error metrics are computed from it.
float mask_luminance(vec3 p_mask) {
	return dot(p_mask, vec3(MASK_LUMINANCE_R, MASK_LUMINANCE_G, MASK_LUMINANCE_B));
}

#endif
