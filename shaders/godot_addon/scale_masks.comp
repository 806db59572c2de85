#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "godot_addon/godot_addon_shared.h"
#include "godot_addon/surface_inc.glsl"

layout(local_size_x = 8, local_size_y = 8, local_size_z = 1) in;
layout(set = 0, binding = SCALE_BINDING_FULL_DEPTH) uniform texture2D full_depth_texture;
layout(set = 0, binding = SCALE_BINDING_DEPTH) uniform texture2D depth_texture; // of the masks
layout(set = 0, binding = SCALE_BINDING_MASKS) uniform texture2DArray masks_texture;
layout(set = 0, binding = SCALE_BINDING_RESULT, r16f) uniform writeonly image2DArray result_image;
layout(push_constant) uniform Push {
	ScalePush push;
};

// Relative difference of near / z from the plane of the pixel's surface at which a tap has half of its weight.
const float SURFACE_TOLERANCE = 1e-3;

// Resizes the masks: averages the four mask pixels around this pixel with bilinear weights, which are reduced for
// pixels that are not on this pixel's surface. A mask below 0 marks a pixel that is no receiver of the light and is not
// averaged: it is the result if its pixel has the largest weight.
void main() {
	const ivec3 item = ivec3(gl_GlobalInvocationID);
	const ivec2 size = textureSize(full_depth_texture, 0);
	if (any(greaterThanEqual(item.xy, size))) {
		return;
	}
	const float depth = texelFetch(full_depth_texture, item.xy, 0).r;
	const vec2 slope = find_slope(full_depth_texture, item.xy) / push.ratio; // per pixel of the masks
	const vec2 position = (vec2(item.xy) + 0.5) * push.ratio - 0.5;
	const ivec2 first = ivec2(floor(position));
	const ivec2 last = textureSize(depth_texture, 0) - 1;
	float sum = 0.0;
	float weight_sum = 0.0;
	float max_weight = 0.0;
	float nearest = -1.0;
	for (int corner = 0; corner < 4; ++corner) {
		const ivec2 tap = clamp(first + ivec2(corner & 1, corner >> 1), ivec2(0), last);
		const vec2 offset = vec2(tap) - position;
		const vec2 bilinear = max(1.0 - abs(offset), 1e-3); // above 0, so that each tap on the surface counts
		const float tap_depth = texelFetch(depth_texture, tap, 0).r;
		const float relative_error = abs(tap_depth - depth - dot(slope, offset)) / max(depth, 1e-20) / SURFACE_TOLERANCE;
		const float weight = bilinear.x * bilinear.y /
				(1.0 + relative_error * relative_error * relative_error * relative_error);
		const float mask = texelFetch(masks_texture, ivec3(tap, item.z), 0).r;
		if (mask >= 0.0) {
			sum += weight * mask;
			weight_sum += weight;
		}
		if (weight > max_weight) {
			max_weight = weight;
			nearest = mask;
		}
	}
	const float mask = nearest >= 0.0 ? sum / weight_sum : nearest;
	imageStore(result_image, item, vec4(mask));
}
