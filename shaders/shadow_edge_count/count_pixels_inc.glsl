// The receiver of a pixel, in light space.
#ifndef COUNT_PIXELS_INC_GLSL
#define COUNT_PIXELS_INC_GLSL

#include "common/receiver_pixels_inc.glsl"
#include "shadow_edge_count/count_constants_inc.glsl"
#include "shadow_edge_count/count_space_inc.glsl"

// Copies of constants, for speed: see count_constants_inc.glsl.
FrameConstants frame_copy;
mat4 light_from_camera;

void load_count_constants() {
	load_light();
	frame_copy = frame;
	light_from_camera = light_views.views[0].view_from_camera_relative;
}

/// The position in the 8 x 8 block of the pixel with this index, 0..63. The order is Morton's, so that pixels with
/// consecutive indices are close together.
uvec2 find_pixel_in_block(uint p_index) {
	const uint x = (p_index & 1u) | ((p_index >> 1) & 2u) | ((p_index >> 2) & 4u);
	const uint y = ((p_index >> 1) & 1u) | ((p_index >> 2) & 2u) | ((p_index >> 3) & 4u);
	return uvec2(x, y);
}

/// The index of a pixel for find_pixel_in_block.
uint find_pixel_index(uvec2 p_pixel) {
	return (p_pixel.x & 1u) | (p_pixel.y & 1u) << 1 | (p_pixel.x & 2u) << 1 | (p_pixel.y & 2u) << 2 |
			(p_pixel.x & 4u) << 2 | (p_pixel.y & 4u) << 3;
}

const uint SMOOTH_SIDE = 4u; // number of the rows and columns of a smooth leaf that are counted

/// These rows and columns: 0, 2, 5 and 7. They are symmetric about the middle and include the outermost ones, so that
/// nothing is extrapolated.
uvec2 find_smooth_pixel(uint p_index) {
	const uvec2 line = uvec2(p_index % SMOOTH_SIDE, p_index / SMOOTH_SIDE);
	return 2u * line + uvec2(greaterThan(line, uvec2(1u)));
}

/// Index of the set bit that has p_rank set bits below it. 0 if there are not so many.
uint find_set_bit(uvec2 p_bits, uint p_rank) {
	const uint low_count = uint(bitCount(p_bits.x));
	const bool is_high = p_rank >= low_count;
	const uint bits = is_high ? p_bits.y : p_bits.x;
	uint rank = is_high ? p_rank - low_count : p_rank;
	uint index = 0u;
	for (uint width = 16u; width > 0u; width >>= 1u) {
		const uint count = uint(bitCount(bits >> index & (1u << width) - 1u));
		const bool is_beyond = rank >= count;
		rank -= is_beyond ? count : 0u;
		index += is_beyond ? width : 0u;
	}
	return (is_high ? 32u : 0u) + min(index, 31u);
}

/// p_position: camera-relative.
vec3 find_light_position(vec3 p_position) {
	return (light_from_camera * vec4(p_position, 1.0)).xyz;
}

#endif
