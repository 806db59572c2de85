#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "common/normal_inc.glsl"
#include "receiver_scatter/receiver_scatter_shared.h"
#include "shared/frame_shared.h"

// Packs the data of a pixel that samples read into four 32-bit words, because many other pixels look it up: depth;
// normal; a key of the material, and the mask's blue; the mask's red and green.
layout(local_size_x = SCATTER_GROUP_SIZE, local_size_y = SCATTER_GROUP_SIZE) in;
layout(std140, set = 0, binding = SCATTER_BINDING_FRAME) restrict readonly buffer Frame {
	FrameConstants frame;
};
layout(set = 0, binding = SCATTER_BINDING_DEPTH) uniform texture2D depth_texture;
layout(set = 0, binding = SCATTER_BINDING_NORMAL) uniform utexture2D normal_texture;
layout(set = 0, binding = SCATTER_BINDING_MATERIAL) uniform texture2D material_texture;
layout(set = 0, binding = SCATTER_BINDING_RECEIVERS) uniform texture2D receivers_texture;
layout(set = 0, binding = SCATTER_BINDING_MASK) uniform texture2D mask_texture;
layout(set = 0, binding = SCATTER_BINDING_PIXELS, rgba32ui) uniform writeonly uimage2D pixels_image;

/// Returns a hash of scatter and scatter distance, 1..0xffff. One in 65,535 pairs of materials has the same key; then
/// only position and normal distinguish their surfaces.
uint find_material_key(vec2 p_scatter_and_distance) {
	// Multipliers: 2^32 / golden ratio (Knuth), and the second prime of xxHash.
	uint hash = packHalf2x16(p_scatter_and_distance) * 2654435769u;
	hash = (hash ^ (hash >> 15u)) * 2246822519u;
	return 1u + (hash >> 16u) % 0xffffu;
}

void main() {
	const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
	if (any(greaterThanEqual(pixel, ivec2(frame.size_px)))) {
		return;
	}
	const float depth = texelFetch(depth_texture, pixel, 0).r;
	uvec4 packed = uvec4(0u);
	if (depth > 0.0) { // 0: background
		const bool is_reached = texelFetch(receivers_texture, pixel, 0).r > 0.0;
		const vec2 material = texelFetch(material_texture, pixel, 0).rg;
		const vec3 light = is_reached ? texelFetch(mask_texture, pixel, 0).rgb : vec3(0.0);
		const uint key = is_reached && material.r > 0.0 ? find_material_key(material) : 0u;
		packed = uvec4(floatBitsToUint(depth), texelFetch(normal_texture, pixel, 0).r,
				(key << 16u) | packHalf2x16(vec2(light.b, 0.0)), packHalf2x16(light.rg));
	}
	imageStore(pixels_image, pixel, packed);
}
