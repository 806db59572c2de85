#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "common/depth_inc.glsl"
#include "common/light_inc.glsl"
#include "common/normal_inc.glsl"
#include "shadow_volume/shadow_volume_shared.h"

// Writes the depths against which volumes are tested: those of the receivers, moved off their
// surfaces. Pixels that are not receivers stay at infinity. Initialises the mask of receivers to
// lit (1).
layout(std140, set = 0, binding = RECEIVERS_BINDING_FRAME) restrict readonly buffer Frame {
	FrameConstants frame;
};
layout(set = 0, binding = RECEIVERS_BINDING_DEPTH) uniform texture2D depth_texture;
layout(set = 0, binding = RECEIVERS_BINDING_NORMAL) uniform utexture2D normal_texture;
layout(set = 0, binding = RECEIVERS_BINDING_RECEIVERS) uniform texture2D receivers_texture;
layout(std140, set = 0, binding = RECEIVERS_BINDING_LIGHT) restrict readonly buffer Light {
	LightConstants light;
};
layout(push_constant) uniform Push {
	VolumeReceiversPush push;
};
layout(location = 0) out float out_visibility;

// Limits of the height over the surface, in multiples of the receiver offset.
const float MIN_HEIGHT = 0.25; // for light along the normal; the limit rises to 1 for grazing light
const float MAX_HEIGHT = 4.0;
// For a grazing view ray, the position can be far in front of the receiver. Its distance from the
// receiver is at most this many offsets, unless the height is then below the rasteriser's rounding,
// 1/256 of a pixel.
const float MAX_DISTANCE = 8.0;
const float ROUNDING_PX = 1.0 / 256.0;
const float MAX_SHIFT = 0.5; // maximum shift, as a fraction of the distance to the camera

/// Height over the surface, in multiples of the receiver offset, of the position whose depth is
/// tested against volumes. Near the moved receiver, all points of the light's ray through it have
/// the same visibility, but only positions on the pixel's view ray project to this pixel. So the
/// position is the point of the view ray nearest to the light's ray. The volumes' camera is moved
/// by p_camera_move receiver offsets along VOLUMES_OFFSET_AXIS, so relative to it volumes and the
/// light's ray are moved back by as much. If that is 1 and the receiver's normal is that axis, both
/// rays meet in the receiver itself.
float find_height(vec3 p_normal, vec3 p_to_camera, vec3 p_to_light, float p_camera_move) {
	vec3 camera_move = vec3(0.0);
	camera_move[VOLUMES_OFFSET_AXIS] = p_camera_move;
	const vec3 offset = p_normal - camera_move;
	const float facing = dot(p_normal, p_to_camera);
	const float view_dot_light = dot(p_to_camera, p_to_light);
	const float sine2 = 1.0 - view_dot_light * view_dot_light;
	const float nearest = sine2 > 1e-6
			? facing * (dot(offset, p_to_camera) - view_dot_light * dot(offset, p_to_light)) / sine2
			: 1.0;
	// As a caster, the surface is moved back too. The limits apply to the height over the moved
	// surface.
	const float caster_height = -dot(p_normal, camera_move);
	const float min_height = max(MIN_HEIGHT, 1.0 - dot(p_normal, p_to_light));
	return clamp(nearest, caster_height + min_height, caster_height + MAX_HEIGHT);
}

void main() {
	const ivec2 pixel = ivec2(gl_FragCoord.xy);
	const float receives = texelFetch(receivers_texture, pixel, 0).r;
	if (receives <= 0.0) {
		discard;
	}
	// Of a receiver on its far side, the position is behind the surface.
	const float side = is_on_far_side(receives) ? -1.0 : 1.0;
	const float depth = texelFetch(depth_texture, pixel, 0).r;
	const vec3 normal = side * unpack_normal(texelFetch(normal_texture, pixel, 0).r);
	const vec3 position = position_from_depth(frame, pixel, depth);
	const float distance_m = length(position);
	const vec3 to_camera = -side * position / distance_m;
	const float offset_m = compute_receiver_offset_m(frame, distance_from_depth(frame, depth));
	const float facing = dot(normal, to_camera);
	float shift = MAX_DISTANCE * offset_m / distance_m;
	if (facing > 1e-6) {
		const vec3 to_light = normalize(vector_to_light(light, position + normal * offset_m));
		const float pixel_m = frame.pixel_size_per_m * distance_m;
		const float height_m =
				find_height(normal, to_camera, to_light, push.camera_move_m / offset_m) * offset_m;
		const float farthest_m = max(MAX_DISTANCE * facing * offset_m, ROUNDING_PX * pixel_m);
		shift = clamp(height_m, -farthest_m, farthest_m) / (facing * distance_m);
	}
	gl_FragDepth = min(depth / (1.0 - side * min(shift, MAX_SHIFT)), 1.0);
	out_visibility = 1.0;
}
