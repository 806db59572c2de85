// The data of a pixel that the passes of receiver_scatter read.
#ifndef RECEIVER_SCATTER_RECEIVER_INC_GLSL
#define RECEIVER_SCATTER_RECEIVER_INC_GLSL

#include "common/depth_inc.glsl"
#include "common/normal_inc.glsl"
#include "receiver_scatter/receiver_scatter_shared.h"

layout(std140, set = 0, binding = SCATTER_BINDING_FRAME) restrict readonly buffer Frame {
	FrameConstants frame;
};
layout(set = 0, binding = SCATTER_BINDING_MATERIAL) uniform texture2D material_texture;
layout(set = 0, binding = SCATTER_BINDING_MASK) uniform texture2D mask_texture;
layout(set = 0,
		binding = SCATTER_BINDING_PIXELS) uniform utexture2D pixels_texture; // result of pack.comp
// Has the mask's format.
layout(set = 0, binding = SCATTER_BINDING_RESULT) uniform writeonly image2D result_image;
layout(push_constant) uniform Push {
	ReceiverScatterPush push;
};

bool is_in_image(ivec2 p_pixel) {
	return all(greaterThanEqual(p_pixel, ivec2(0))) && all(lessThan(p_pixel, ivec2(frame.size_px)));
}

uvec4 load_pixel(ivec2 p_pixel) {
	return texelFetch(pixels_texture, p_pixel, 0);
}

float get_depth(uvec4 p_packed) {
	return uintBitsToFloat(p_packed.x);
}

/// The light that arrives: the mask, or 0 where the surface faces away from the light or is outside
/// its cone or range.
vec3 get_light(uvec4 p_packed) {
	return vec3(unpackHalf2x16(p_packed.w), unpackHalf2x16(p_packed.z).x);
}

/// Key of the material (see pack.comp); 0 where the material does not scatter or the light cannot
/// reach.
uint get_material_key(uvec4 p_packed) {
	return p_packed.z >> 16u;
}

/// A pixel that the light reaches, and whose material scatters.
struct Receiver {
	vec3 position; // camera-relative
	vec3 normal;   // geometric
	uint material_key;
	float scatter; // s in 0..1
	float scatter_distance_m;
	float pixel_size_m; // width of a pixel at the receiver's distance, across the view
	float radius_m;		// within which 95 % of the light enters, see DipoleSpread; finite
};

/// Loads a pixel's receiver. Returns false when the pixel is none: its mask then stays as it is.
bool load_receiver(ivec2 p_pixel, out Receiver r_receiver) {
	const uvec4 packed = load_pixel(p_pixel);
	r_receiver.material_key = get_material_key(packed);
	if (r_receiver.material_key == 0u) {
		return false;
	}
	const float depth = get_depth(packed);
	const vec2 material = texelFetch(material_texture, p_pixel, 0).rg;
	r_receiver.position = position_from_depth(frame, p_pixel, depth);
	r_receiver.normal = unpack_normal(packed.y);
	r_receiver.scatter = min(material.r, 1.0);
	r_receiver.scatter_distance_m = material.g;
	r_receiver.pixel_size_m = frame.pixel_size_per_m * distance_from_depth(frame, depth);
	const float distance_m =
			material.g > 0.0 ? material.g : SCATTER_RADIUS_PX * r_receiver.pixel_size_m;
	r_receiver.radius_m = min(r_receiver.scatter * distance_m, 1e6 * frame.scene_size_m);
	return true;
}

/// True when the method in metres is used for the receiver, false for the method in pixels.
bool is_metric(Receiver p_receiver) {
	return push.method == SCATTER_METHOD_METRES ||
			(push.method == SCATTER_METHOD_AUTO && p_receiver.scatter_distance_m > 0.0);
}

/// Width of the block of pixels that take different samples: 1, 2 or 4.
int find_block_width(Receiver p_receiver) {
	const float radius_px = p_receiver.radius_m / p_receiver.pixel_size_m;
	return radius_px < SCATTER_RADIUS_OF_2_PX ? 1 : radius_px < SCATTER_RADIUS_OF_4_PX ? 2 : 4;
}

/// Index of the set from which a pixel takes its samples. The sets of blocks of width 1, 2 and 4
/// follow one another.
uint find_set(ivec2 p_pixel, int p_block_width) {
	const uvec2 offset = uvec2(p_pixel) % uint(p_block_width);
	const uint first = p_block_width == 1 ? 0u : p_block_width == 2 ? 1u : 5u;
	return first + offset.x + uint(p_block_width) * offset.y;
}

/// True when samples on other surfaces are skipped.
bool refuses_others(Receiver p_receiver) {
	return push.refusal == SCATTER_REFUSAL_ON ||
			(push.refusal == SCATTER_REFUSAL_AUTO && is_metric(p_receiver));
}

/// True when the light can reach the pixel, and the pixel has the receiver's material, faces the
/// same side and is no farther from p_expected than p_tolerance_m.
bool is_same_surface(
		Receiver p_receiver, ivec2 p_pixel, uvec4 p_packed, vec3 p_expected, float p_tolerance_m) {
	if (get_material_key(p_packed) != p_receiver.material_key) {
		return false;
	}
	const vec3 offset_m = position_from_depth(frame, p_pixel, get_depth(p_packed)) - p_expected;
	return dot(offset_m, offset_m) <= p_tolerance_m * p_tolerance_m &&
			dot(unpack_normal(p_packed.y), p_receiver.normal) > 0.0;
}

#endif
