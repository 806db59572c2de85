#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "common/light_inc.glsl"
#include "common/receiver_inc.glsl"
#include "shadow_volume/shadow_volume_shared.h"

// The depth that volumes are compared with: that of each receiver, moved off its surface. What does not
// receive stays at infinity. The mask begins as lit.
layout(set = 0, binding = RECEIVERS_BINDING_FRAME) uniform Frame {
	FrameConstants frame;
};
layout(set = 0, binding = RECEIVERS_BINDING_DEPTH) uniform texture2D depth_texture;
layout(set = 0, binding = RECEIVERS_BINDING_NORMAL) uniform utexture2D normal_texture;
layout(set = 0, binding = RECEIVERS_BINDING_RECEIVERS) uniform texture2D receivers_texture;
layout(set = 0, binding = RECEIVERS_BINDING_LIGHT) uniform Light {
	LightConstants light;
};
layout(location = 0) out float out_visibility;

// Heights of the place over the surface, in parts of the offset.
const float LEAST_HEIGHT = 0.25; // where the light is steep; the nearer to the plane, the higher
const float GREATEST_HEIGHT = 4.0;
// A grazing view finds a height far in front of the receiver: no farther than so many offsets, as long as
// that is higher than the rasteriser's rounding, 1/256 pixel.
const float FARTHEST = 8.0;
const float ROUNDING_PX = 1.0 / 256.0;
const float GREATEST_SHIFT = 0.5; // of the distance, in any case

/// The height over the surface, metres, of the place on the pixel's ray that is nearest to the light's ray
/// through the moved receiver: volumes are compared there, as every point of the light's ray has the
/// receiver's shadow, but only places on the pixel's ray are seen by this pixel. p_facing: cosine of normal
/// and view.
float find_height(float p_facing, float p_light_facing, float p_between, float p_offset_m, float p_pixel_m) {
	const float sine2 = 1.0 - p_between * p_between;
	const float nearest = sine2 > 1e-6 ? p_facing * (p_facing - p_between * p_light_facing) / sine2 : 1.0;
	const float least = max(LEAST_HEIGHT, 1.0 - p_light_facing);
	const float height_m = clamp(nearest, least, GREATEST_HEIGHT) * p_offset_m;
	return min(height_m, max(FARTHEST * p_facing * p_offset_m, ROUNDING_PX * p_pixel_m));
}

void main() {
	const ivec2 pixel = ivec2(gl_FragCoord.xy);
	if (texelFetch(receivers_texture, pixel, 0).r <= 0.0) {
		discard;
	}
	const float depth = texelFetch(depth_texture, pixel, 0).r;
	const vec3 normal = unpack_normal(texelFetch(normal_texture, pixel, 0).r);
	const vec3 position = position_from_depth(frame, pixel, depth);
	const float distance_m = length(position);
	const vec3 to_camera = -position / distance_m;
	const float offset_m = RECEIVER_OFFSET * frame.scene_size_m;
	const float facing = dot(normal, to_camera);
	float shift = FARTHEST * offset_m / distance_m;
	if (facing > 1e-6) {
		const vec3 to_light = normalize(vector_to_light(light, position + normal * offset_m));
		const float pixel_m = distance_m * 2.0 * length(frame.up_tangent.xyz) / float(frame.size_px.y);
		const float height_m = find_height(
				facing, dot(normal, to_light), dot(to_camera, to_light), offset_m, pixel_m);
		shift = height_m / (facing * distance_m);
	}
	gl_FragDepth = min(depth / (1.0 - min(shift, GREATEST_SHIFT)), 1.0);
	out_visibility = 1.0;
}
