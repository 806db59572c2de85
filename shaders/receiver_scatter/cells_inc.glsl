// The cells (rings times sectors) of the sampling disc of Wang and Xiao 2015, section 1.2: pure functions.
#ifndef RECEIVER_SCATTER_CELLS_INC_GLSL
#define RECEIVER_SCATTER_CELLS_INC_GLSL

#include "common/sampling_inc.glsl"
#include "receiver_scatter/receiver_scatter_shared.h"

/// Number of rings, c in the paper: the radius R = 16 s in pixels, rounded up. p_scatter: s in 0..1.
uint count_rings(float p_scatter) {
	return uint(ceil(SCATTER_RADIUS_PX * p_scatter));
}

/// A random point of a cell, in pixels from the disc's centre. p_counts: numbers of rings and sectors. p_random: two
/// numbers in 0..1, for the position across the ring and along it.
vec2 find_cell_point(
		uvec2 p_ring_and_sector, uvec2 p_counts, float p_radius_px, vec2 p_random) {
	const vec2 position = (vec2(p_ring_and_sector) + p_random) / vec2(p_counts);
	const float angle_rad = TWO_PI * position.y;
	return p_radius_px * position.x * vec2(cos(angle_rad), sin(angle_rad));
}

/// Weight that falls with the distance; 1 at the disc's centre.
float find_disc_weight(float p_distance_px, float p_radius_px) {
	return exp(-SCATTER_FALLOFF * p_distance_px / p_radius_px);
}

#endif
