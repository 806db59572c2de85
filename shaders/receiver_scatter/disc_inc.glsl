// The method in pixels, of Wang and Xiao 2015: a disc in the image is divided into rings times sectors, each cell gets
// one random sample, and the weights of the mean fall with the distance.
#ifndef RECEIVER_SCATTER_DISC_INC_GLSL
#define RECEIVER_SCATTER_DISC_INC_GLSL

#include "receiver_scatter/cells_inc.glsl"
#include "receiver_scatter/receiver_inc.glsl"

/// Weighted mean of the light at the samples.
vec3 spread_in_pixels(ivec2 p_pixel, Receiver p_receiver) {
	const float radius_px = SCATTER_RADIUS_PX * p_receiver.scatter;
	const uvec2 counts = uvec2(count_rings(p_receiver.scatter), push.sector_count);
	const bool refuses = refuses_others(p_receiver);
	uint random = hash_pixel(uvec2(p_pixel));
	vec3 sum = vec3(0.0);
	float weight_sum = 0.0;
	for (uint ring = 0u; ring < counts.x; ++ring) {
		for (uint sector = 0u; sector < counts.y; ++sector) {
			const float across = next_random(random);
			const float along = next_random(random);
			const vec2 offset_px =
					find_cell_point(uvec2(ring, sector), counts, radius_px, vec2(across, along));
			const ivec2 other = p_pixel + ivec2(round(offset_px));
			if (!is_in_image(other)) {
				continue;
			}
			const uvec4 packed = load_pixel(other);
			const float distance_px = length(offset_px);
			// Points of a plane at 60 degrees to the image are twice as far apart; 1: rounding.
			const float tolerance_m = 2.0 * (distance_px + 1.0) * p_receiver.pixel_size_m;
			if (refuses ? is_same_surface(p_receiver, other, packed, p_receiver.position, tolerance_m)
						: get_depth(packed) > 0.0) {
				const float weight = find_disc_weight(distance_px, radius_px);
				sum += weight * get_light(packed);
				weight_sum += weight;
			}
		}
	}
	return weight_sum > 0.0 ? sum / weight_sum : get_light(load_pixel(p_pixel));
}

#endif
