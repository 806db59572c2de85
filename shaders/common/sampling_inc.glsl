// Sets of points, and how they turn from pixel to pixel.
#ifndef SAMPLING_INC_GLSL
#define SAMPLING_INC_GLSL

const float GOLDEN_ANGLE_RAD = 2.399963229728653;
const float TWO_PI = 6.283185307179586;

/// Point p_index of p_count on the unit disc, evenly spread for any count (Vogel 1979).
vec2 vogel_disc(uint p_index, uint p_count, float p_angle_rad) {
	const float radius = sqrt((float(p_index) + 0.5) / float(p_count));
	const float angle_rad = float(p_index) * GOLDEN_ANGLE_RAD + p_angle_rad;
	return radius * vec2(cos(angle_rad), sin(angle_rad));
}

/// 0..1, as different as can be between neighbouring pixels: interleaved gradient noise (Jimenez
/// 2014, Next generation post processing in Call of Duty).
float interleaved_noise(ivec2 p_pixel) {
	return fract(52.9829189 * fract(dot(vec2(p_pixel), vec2(0.06711056, 0.00583715))));
}

#endif
