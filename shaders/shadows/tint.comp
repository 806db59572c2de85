#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "shadows/shadows_shared.h"
#include "shared/mask_shared.h"

// Colours a mask by a group of translucent casters. Of the light that the opaque casters let
// through, the group hides the fraction 1 - both / opaque, and transmits its transmittance times
// that fraction. `both`: the visibility with the opaque casters and the group, `opaque`: without
// the group. This is exact for one group. Several groups are multiplied as if they hid light
// independently, which is exact where each hides all of it or nothing.
layout(local_size_x = SURFACE_GROUP_SIZE, local_size_y = SURFACE_GROUP_SIZE) in;
layout(set = 0, binding = TINT_BINDING_OPAQUE) uniform texture2D opaque_texture;
layout(set = 0, binding = TINT_BINDING_BOTH) uniform texture2D both_texture;
layout(set = 0, binding = TINT_BINDING_BEFORE) uniform texture2D before_texture;
layout(set = 0, binding = TINT_BINDING_RESULT, rgba16f) uniform writeonly image2D result_image;
layout(constant_id = MASK_CONSTANT_IS_COLORED) const uint IS_COLORED = 0u; // 1: before_texture has three channels
layout(push_constant) uniform Push {
	TintPush push;
};

void main() {
	const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
	if (any(greaterThanEqual(pixel, imageSize(result_image)))) {
		return;
	}
	const vec4 stored = texelFetch(before_texture, pixel, 0);
	const vec3 before = IS_COLORED != 0u ? stored.rgb : stored.rrr;
	const float opaque = texelFetch(opaque_texture, pixel, 0).r;
	const float both = texelFetch(both_texture, pixel, 0).r;
	const float hidden = opaque > 0.0 ? clamp(1.0 - both / opaque, 0.0, 1.0) : 0.0;
	imageStore(result_image, pixel, vec4(before * (1.0 - hidden * (1.0 - push.transmittance.rgb)), 1.0));
}
