// What the passes of receiver_scatter know of a pixel.
#ifndef RECEIVER_SCATTER_RECEIVER_INC_GLSL
#define RECEIVER_SCATTER_RECEIVER_INC_GLSL

#include "common/depth_inc.glsl"
#include "common/normal_inc.glsl"
#include "receiver_scatter/receiver_scatter_shared.h"

layout(set = 0, binding = SCATTER_BINDING_FRAME) uniform Frame {
	FrameConstants frame;
};
layout(set = 0, binding = SCATTER_BINDING_DEPTH) uniform texture2D depth_texture;
layout(set = 0, binding = SCATTER_BINDING_NORMAL) uniform utexture2D normal_texture;
layout(set = 0, binding = SCATTER_BINDING_MATERIAL) uniform texture2D material_texture;
layout(set = 0, binding = SCATTER_BINDING_RECEIVERS) uniform texture2D receivers_texture;
layout(set = 0, binding = SCATTER_BINDING_MASK) uniform texture2D mask_texture;
// Of the mask's format, whichever that is.
layout(set = 0, binding = SCATTER_BINDING_RESULT) uniform writeonly image2D result_image;
layout(push_constant) uniform Push {
	ReceiverScatterPush push;
};

bool is_in_picture(ivec2 p_pixel) {
	return all(greaterThanEqual(p_pixel, ivec2(0))) && all(lessThan(p_pixel, ivec2(frame.size_px)));
}

vec3 load_mask(ivec2 p_pixel) {
	return texelFetch(mask_texture, p_pixel, 0).rgb;
}

bool is_reached(ivec2 p_pixel) {
	return texelFetch(receivers_texture, p_pixel, 0).r != 0.0;
}

/// As load_mask; 0 where the surface is turned away from the light or outside of it, where masks may
/// hold anything.
vec3 load_light(ivec2 p_pixel) {
	return is_reached(p_pixel) ? load_mask(p_pixel) : vec3(0.0);
}

/// A pixel that the light reaches.
struct Receiver {
	vec3 position; // camera-relative
	vec3 normal;   // geometric
	float scatter; // s in 0..1, 0 also where it is no number
	float scatter_distance_m;
	float pixel_size_m; // how wide a pixel is there, across the view
	float radius_m;		// of the disc from which the light comes, see DipoleSpread; finite
};

/// False where the light does not reach or the surface does not scatter: the mask stays as it is.
bool load_receiver(ivec2 p_pixel, out Receiver r_receiver) {
	const float depth = texelFetch(depth_texture, p_pixel, 0).r;
	const vec2 material = texelFetch(material_texture, p_pixel, 0).rg;
	if (!(depth > 0.0) || !(material.r > 0.0) || !is_reached(p_pixel)) {
		return false;
	}
	r_receiver.position = position_from_depth(frame, p_pixel, depth);
	r_receiver.normal = unpack_normal(texelFetch(normal_texture, p_pixel, 0).r);
	r_receiver.scatter = min(material.r, 1.0);
	r_receiver.scatter_distance_m = material.g;
	r_receiver.pixel_size_m =
			2.0 * frame.near_m / depth * length(frame.up_tangent.xyz) / float(frame.size_px.y);
	const float distance_m =
			material.g > 0.0 ? material.g : SCATTER_RADIUS_PX * r_receiver.pixel_size_m;
	r_receiver.radius_m = min(r_receiver.scatter * distance_m, 1e6 * frame.scene_size_m);
	return true;
}

bool is_same_material(Receiver p_receiver, Receiver p_other) {
	return p_other.scatter == p_receiver.scatter &&
			p_other.scatter_distance_m == p_receiver.scatter_distance_m;
}

/// Which of the two methods serves it.
bool is_metric(Receiver p_receiver) {
	return push.method == SCATTER_METHOD_METRES ||
			(push.method == SCATTER_METHOD_AUTO && p_receiver.scatter_distance_m > 0.0);
}

/// Width of the block of pixels that take different samples: 1, 2 or 4.
int find_block_width(Receiver p_receiver) {
	const float radius_px = p_receiver.radius_m / p_receiver.pixel_size_m;
	return radius_px < SCATTER_RADIUS_OF_2_PX ? 1 : radius_px < SCATTER_RADIUS_OF_4_PX ? 2 : 4;
}

/// Which set a pixel takes: those of width 1, 2 and 4 follow one another.
uint find_set(ivec2 p_pixel, int p_block_width) {
	const uvec2 place = uvec2(p_pixel) % uint(p_block_width);
	const uint first = p_block_width == 1 ? 0u : p_block_width == 2 ? 1u : 5u;
	return first + place.x + uint(p_block_width) * place.y;
}

/// Does a pixel count for the receiver? It must show a surface; where others are refused, one of the
/// receiver's material that the light reaches, turned towards the same side and no farther from
/// p_expected than p_tolerance_m.
bool is_sample(Receiver p_receiver, ivec2 p_pixel, vec3 p_expected, float p_tolerance_m) {
	if (!is_in_picture(p_pixel)) {
		return false;
	}
	const bool refuses = push.refusal == SCATTER_REFUSAL_ON ||
			(push.refusal == SCATTER_REFUSAL_AUTO && is_metric(p_receiver));
	if (!refuses) {
		return texelFetch(depth_texture, p_pixel, 0).r > 0.0;
	}
	Receiver other;
	return load_receiver(p_pixel, other) && is_same_material(p_receiver, other) &&
			dot(other.normal, p_receiver.normal) > 0.0 &&
			distance(other.position, p_expected) <= p_tolerance_m;
}

#endif
