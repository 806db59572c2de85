#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "common/depth_inc.glsl"
#include "common/light_inc.glsl"
#include "common/normal_inc.glsl"
#include "renderer/brdf_inc.glsl"
#include "renderer/renderer_shared.h"
#include "shared/mask_shared.h"

#define LIT_TILES_BINDING RENDERER_BINDING_TILES
#include "common/lit_tiles_inc.glsl"

// Adds one light, times its visibility mask and the exposure, to the frame's radiance.
layout(local_size_x = RENDERER_GROUP_SIZE, local_size_y = RENDERER_GROUP_SIZE) in;
layout(std140, set = 0, binding = RENDERER_BINDING_FRAME) restrict readonly buffer Frame {
	FrameConstants frame;
};
layout(std140, set = 0, binding = RENDERER_BINDING_LIGHT) restrict readonly buffer Light {
	LightConstants light;
};
layout(set = 0, binding = RENDERER_BINDING_DEPTH) uniform texture2D depth_texture;
layout(set = 0, binding = RENDERER_BINDING_SHADING_NORMAL) uniform utexture2D normal_texture;
layout(set = 0, binding = RENDERER_BINDING_MATERIAL) uniform texture2D material_texture;
layout(set = 0, binding = RENDERER_BINDING_BASE_COLOR) uniform texture2D base_color_texture;
layout(set = 0, binding = RENDERER_BINDING_RECEIVERS) uniform texture2D receivers_texture;
layout(set = 0, binding = RENDERER_BINDING_MASK) uniform texture2D mask_texture;
layout(set = 0, binding = RENDERER_BINDING_RADIANCE, rgba16f) uniform image2D radiance_image;
layout(constant_id = MASK_CONSTANT_IS_COLORED) const uint IS_COLORED = 0u;
layout(push_constant) uniform Push {
	ExposurePush push;
};

void main() {
	const ivec2 pixel = find_lit_pixel(frame.size_px);
	if (any(greaterThanEqual(pixel, ivec2(frame.size_px)))) {
		return;
	}
	if (texelFetch(receivers_texture, pixel, 0).r == 0.0) {
		return;
	}
	const vec4 mask = texelFetch(mask_texture, pixel, 0);
	const vec3 visibility = IS_COLORED != 0u ? mask.rgb : mask.rrr;
	const vec3 position =
			position_from_depth(frame, pixel, texelFetch(depth_texture, pixel, 0).r);
	const vec3 to_light = vector_to_light(light, position);
	const vec4 material = texelFetch(material_texture, pixel, 0);
	const Surface surface = make_surface(texelFetch(base_color_texture, pixel, 0).rgb, material);
	const vec3 reflected =
			reflect_light(surface, unpack_normal(texelFetch(normal_texture, pixel, 0).r),
					normalize(-position), normalize(to_light));
	// The exposure is applied before the sum is stored as half floats, so that lights of 1e6 cd do
	// not overflow.
	const vec3 added = reflected * illuminance(light, to_light) * visibility * push.ambient.a;
	const vec3 sum = imageLoad(radiance_image, pixel).rgb + added;
	imageStore(radiance_image, pixel, vec4(min(sum, vec3(RENDERER_MAX_RADIANCE)), 1.0));
}
