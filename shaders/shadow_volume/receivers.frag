#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "common/light_inc.glsl"
#include "common/receiver_inc.glsl"
#include "shadow_volume/shadow_volume_shared.h"

// The depth that volumes are compared with: that of each receiver, moved off its surface. What does not
// receive stays at infinity. The mask begins as lit.
layout(std140, set = 0, binding = RECEIVERS_BINDING_FRAME) restrict readonly buffer Frame {
	FrameConstants frame;
};
layout(set = 0, binding = RECEIVERS_BINDING_DEPTH) uniform texture2D depth_texture;
layout(set = 0, binding = RECEIVERS_BINDING_NORMAL) uniform utexture2D normal_texture;
layout(set = 0, binding = RECEIVERS_BINDING_RECEIVERS) uniform texture2D receivers_texture;
layout(std140, set = 0, binding = RECEIVERS_BINDING_LIGHT) restrict readonly buffer Light {
	LightConstants light;
};
layout(location = 0) out float out_visibility;

// Heights of the position over the surface, in parts of the offset.
const float LEAST_HEIGHT = 0.25; // where the light is steep; the nearer to the plane, the higher
const float GREATEST_HEIGHT = 4.0;
// A grazing view finds a height far in front of the receiver: no farther than so many offsets, as long as
// that is higher than the rasteriser's rounding, 1/256 pixel.
const float FARTHEST = 8.0;
const float ROUNDING_PX = 1.0 / 256.0;
const float GREATEST_SHIFT = 0.5; // of the distance, in any case

/// The height over the surface, in offsets, of the position on the pixel's ray that is nearest to the
/// light's ray through the moved receiver: volumes are compared there, as every point of the light's ray
/// has the receiver's shadow, but only positions on the pixel's ray are seen by this pixel. The volumes'
/// camera is moved by one offset along an axis, which has the effect that volumes and the light's ray are
/// moved back by as much: for a receiver with that normal the two rays meet in the receiver itself.
float find_height(vec3 p_normal, vec3 p_to_camera, vec3 p_to_light) {
	vec3 camera_move = vec3(0.0);
	camera_move[VOLUMES_MOVED_AXIS] = 1.0;
	const vec3 offset = p_normal - camera_move;
	const float facing = dot(p_normal, p_to_camera);
	const float between = dot(p_to_camera, p_to_light);
	const float sine2 = 1.0 - between * between;
	const float nearest = sine2 > 1e-6
			? facing * (dot(offset, p_to_camera) - between * dot(offset, p_to_light)) / sine2
			: 1.0;
	// The surface as a caster is moved back, too: the limits are over that.
	const float caster_height = -dot(p_normal, camera_move);
	const float least = max(LEAST_HEIGHT, 1.0 - dot(p_normal, p_to_light));
	return clamp(nearest, caster_height + least, caster_height + GREATEST_HEIGHT);
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
		const float height_m = find_height(normal, to_camera, to_light) * offset_m;
		const float farthest_m = max(FARTHEST * facing * offset_m, ROUNDING_PX * pixel_m);
		shift = clamp(height_m, -farthest_m, farthest_m) / (facing * distance_m);
	}
	gl_FragDepth = min(depth / (1.0 - min(shift, GREATEST_SHIFT)), 1.0);
	out_visibility = 1.0;
}
