// The source's method, in pixels: Wang and Xiao 2015, section 1.2. A disc of radius 16 s in the
// picture, sectors times rings, one random point in each cell, a mean whose weights fall with the
// distance.
#ifndef RECEIVER_SCATTER_DISC_INC_GLSL
#define RECEIVER_SCATTER_DISC_INC_GLSL

#include "common/sampling_inc.glsl"
#include "receiver_scatter/receiver_inc.glsl"

vec3 spread_in_pixels(ivec2 p_pixel, Receiver p_receiver) {
	const float radius_px = SCATTER_RADIUS_PX * p_receiver.scatter;
	const uint ring_count = uint(ceil(radius_px));
	const bool refuses = refuses_others(p_receiver);
	uint random = hash_pixel(uvec2(p_pixel));
	vec3 sum = vec3(0.0);
	float weight_sum = 0.0;
	for (uint ring = 0u; ring < ring_count; ++ring) {
		for (uint sector = 0u; sector < push.sector_count; ++sector) {
			const float distance_px =
					(float(ring) + next_random(random)) * radius_px / float(ring_count);
			const float angle_rad =
					(float(sector) + next_random(random)) * TWO_PI / float(push.sector_count);
			const ivec2 other =
					p_pixel + ivec2(round(distance_px * vec2(cos(angle_rad), sin(angle_rad))));
			if (!is_in_picture(other)) {
				continue;
			}
			const uvec4 packed = load_pixel(other);
			const float tolerance_m = 2.0 * (distance_px + 1.0) * p_receiver.pixel_size_m;
			if (refuses ? is_same_surface(p_receiver, other, packed, p_receiver.position, tolerance_m)
						: get_depth(packed) > 0.0) {
				const float weight = exp(-SCATTER_FALLOFF * distance_px / radius_px);
				sum += weight * get_light(packed);
				weight_sum += weight;
			}
		}
	}
	return weight_sum > 0.0 ? sum / weight_sum : get_light(load_pixel(p_pixel));
}

#endif
