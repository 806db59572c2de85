// Sample points on a disc, noise and random numbers per pixel, and tangent vectors.
#ifndef SAMPLING_INC_GLSL
#define SAMPLING_INC_GLSL

const float GOLDEN_ANGLE_RAD = 2.399963229728653;
const float TWO_PI = 6.283185307179586;

/// Point p_index of p_count on the unit disc, evenly spread for any count (Vogel 1979). p_angle_rad rotates the set.
vec2 vogel_disc(uint p_index, uint p_count, float p_angle_rad) {
	const float radius = sqrt((float(p_index) + 0.5) / float(p_count));
	const float angle_rad = float(p_index) * GOLDEN_ANGLE_RAD + p_angle_rad;
	return radius * vec2(cos(angle_rad), sin(angle_rad));
}

/// Noise in 0..1 that differs strongly between neighbouring pixels: interleaved gradient noise
/// (Jimenez 2014, Next generation post processing in Call of Duty).
float interleaved_noise(ivec2 p_pixel) {
	return fract(52.9829189 * fract(dot(vec2(p_pixel), vec2(0.06711056, 0.00583715))));
}

/// Two unit vectors perpendicular to a unit vector and to each other (Duff et al. 2017).
void find_tangents(vec3 p_normal, out vec3 r_x, out vec3 r_y) {
	const float z_sign = p_normal.z >= 0.0 ? 1.0 : -1.0;
	const float a = -1.0 / (z_sign + p_normal.z);
	const float b = p_normal.x * p_normal.y * a;
	r_x = vec3(1.0 + z_sign * p_normal.x * p_normal.x * a, z_sign * b, -z_sign * p_normal.x);
	r_y = vec3(b, z_sign + p_normal.y * p_normal.y * a, -p_normal.y);
}

/// Seed of a pixel's random numbers; it depends on the pixel only (pcg2d of Jarzynski, Olano 2020, Hash functions for
/// GPU rendering).
uint hash_pixel(uvec2 p_pixel) {
	uvec2 v = p_pixel * 1664525u + 1013904223u;
	v.x += v.y * 1664525u;
	v.y += v.x * 1664525u;
	v ^= v >> 16u;
	v.x += v.y * 1664525u;
	v.y += v.x * 1664525u;
	v ^= v >> 16u;
	return v.x;
}

/// Next random number of the sequence, uniform in [0, 1) (PCG, same paper). r_state starts as hash_pixel.
float next_random(inout uint r_state) {
	r_state = r_state * 747796405u + 2891336453u;
	const uint word = ((r_state >> ((r_state >> 28u) + 4u)) ^ r_state) * 277803737u;
	return float(((word >> 22u) ^ word) >> 8u) / 16777216.0;
}

#endif
