#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "common/depth_inc.glsl"
#include "common/light_inc.glsl"
#include "common/normal_inc.glsl"
#include "shadows/shadows_shared.h"

#define LIT_TILES_BINDING SURFACE_BINDING_TILES
#include "common/lit_tiles_inc.glsl"

// Marks the receivers: pixels that the light can reach. Masks are only valid there.
layout(local_size_x = SURFACE_GROUP_SIZE, local_size_y = SURFACE_GROUP_SIZE) in;
layout(std140, set = 0, binding = SURFACE_BINDING_FRAME) restrict readonly buffer Frame {
	FrameConstants frame_block;
};
layout(std140, set = 0, binding = SURFACE_BINDING_LIGHT) restrict readonly buffer Light {
	LightConstants light_block;
};
layout(set = 0, binding = SURFACE_BINDING_DEPTH) uniform texture2D depth_texture;
layout(set = 0, binding = SURFACE_BINDING_NORMAL) uniform utexture2D normal_texture;
layout(set = 0, binding = SURFACE_BINDING_RESULT, r8) uniform writeonly image2D receivers_image;

void main() {
	// Copied here: within branches, llvmpipe takes 20 instructions to read a word.
	const FrameConstants frame = frame_block;
	const LightConstants light = light_block;
	const ivec2 pixel = find_lit_pixel(frame.size_px);
	if (any(greaterThanEqual(pixel, ivec2(frame.size_px)))) {
		return;
	}
	const float depth = texelFetch(depth_texture, pixel, 0).r;
	float receives = RECEIVER_NONE;
	if (depth > 0.0) {
		const vec3 normal = unpack_normal(texelFetch(normal_texture, pixel, 0).r);
		const vec3 position = position_from_depth(frame, pixel, depth);
		if (is_receiver(light, position, normal)) {
			receives = RECEIVER_NEAR_SIDE;
		} else if (dot(-normal, normalize(vector_to_light(light, position))) >= frame.right_tangent.w &&
				is_receiver(light, position, -normal)) {
			receives = RECEIVER_FAR_SIDE;
		}
	}
	imageStore(receivers_image, pixel, vec4(receives));
}
