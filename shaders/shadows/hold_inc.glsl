// Copies a light's mask into one layer of a texture array that outlives the frame, see ShadowFrame::hold. The layer's
// other tiles have the value of pixels without a receiver already.
#ifndef HOLD_INC_GLSL
#define HOLD_INC_GLSL

#include "common/mask_inc.glsl"
#include "shared/frame_shared.h"
#include "shadows/shadows_shared.h"

#define LIT_TILES_BINDING HOLD_BINDING_TILES
#include "common/lit_tiles_inc.glsl"

layout(local_size_x = SURFACE_GROUP_SIZE, local_size_y = SURFACE_GROUP_SIZE) in;
layout(set = 0, binding = HOLD_BINDING_MASK) uniform texture2D mask_texture;
layout(set = 0, binding = HOLD_BINDING_RECEIVERS) uniform texture2D receivers_texture;
layout(constant_id = MASK_CONSTANT_IS_COLORED) const uint IS_COLORED = 0u;
layout(push_constant) uniform Push {
	HoldPush push;
};

/// A mask with one channel gives grey.
vec3 load_visibility(ivec2 p_pixel) {
	const vec4 mask = texelFetch(mask_texture, p_pixel, 0);
	const vec3 visibility = IS_COLORED != 0u ? mask.rgb : mask.rrr;
	const float receives = texelFetch(receivers_texture, p_pixel, 0).r;
	if (receives <= 0.0) {
		return vec3(push.no_receiver_value);
	}
	return is_on_far_side(receives) ? push.no_receiver_value - 1.0 - visibility : visibility;
}

#endif
