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

/// A pixel's receiver.
struct CountPoint {
	vec3 position; // light space
	float offset_fraction; // how far it was moved off its surface, as a fraction of the maximum
};

/// The pixel must have a receiver, see is_receiver_pixel.
CountPoint load_count_point(ivec2 p_pixel) {
	const ReceiverPixel pixel = load_receiver(frame_copy, p_pixel);
	return CountPoint((light_from_camera * vec4(pixel.position, 1.0)).xyz,
			pixel.offset_m / frame_copy.max_receiver_offset_m);
}

#endif
