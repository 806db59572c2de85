#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "common/mask_inc.glsl"
#include "renderer/renderer_shared.h"
#include "shared/heat_map_shared.h"

// Shows a mask minus the reference: red where the mask is too bright, blue where it is too dark, white where it is
// equal, and grey where there is no receiver.
layout(local_size_x = RENDERER_GROUP_SIZE, local_size_y = RENDERER_GROUP_SIZE) in;
layout(std430, set = 0, binding = RENDERER_BINDING_REFERENCE) readonly buffer ReferenceMask {
	float reference[]; // below 0: no receiver
};
layout(set = 0, binding = RENDERER_BINDING_RECEIVERS) uniform texture2D receivers_texture;
layout(set = 0, binding = RENDERER_BINDING_MASK) uniform texture2D mask_texture;
layout(set = 0, binding = RENDERER_BINDING_OUTPUT, rgba8) uniform writeonly image2D output_image;
layout(constant_id = MASK_CONSTANT_IS_COLORED) const uint IS_COLORED = 0u;

void main() {
	const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
	const ivec2 size = imageSize(output_image);
	if (any(greaterThanEqual(pixel, size))) {
		return;
	}
	const float reference_visibility = reference[pixel.y * size.x + pixel.x];
	const vec4 mask = texelFetch(mask_texture, pixel, 0);
	const float visibility = IS_COLORED != 0u ? mask_luminance(mask.rgb) : mask.r;
	const float error = (visibility - reference_visibility) / HEAT_MAP_RANGE;
	const float rest = clamp(1.0 - abs(error), 0.0, 1.0);
	const bool is_receiver =
			reference_visibility >= 0.0 && texelFetch(receivers_texture, pixel, 0).r > 0.0;
	const vec3 color = error > 0.0 ? vec3(1.0, rest, rest) : vec3(rest, rest, 1.0);
	imageStore(output_image, pixel,
			vec4(is_receiver ? color : vec3(float(HEAT_MAP_NO_RECEIVER) / 255.0), 1.0));
}
