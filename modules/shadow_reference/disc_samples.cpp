#include "modules/shadow_reference/disc_samples.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

uint32_t reverse_bits(uint32_t p_value) {
	uint32_t value = p_value;
	value = (value >> 16) | (value << 16);
	value = ((value & 0x00ff00ffu) << 8) | ((value & 0xff00ff00u) >> 8);
	value = ((value & 0x0f0f0f0fu) << 4) | ((value & 0xf0f0f0f0u) >> 4);
	value = ((value & 0x33333333u) << 2) | ((value & 0xccccccccu) >> 2);
	return ((value & 0x55555555u) << 1) | ((value & 0xaaaaaaaau) >> 1);
}

/// Second dimension of Sobol's sequence; the first is reverse_bits(index).
uint32_t compute_sobol_2(uint32_t p_index) {
	uint32_t result = 0;
	uint32_t direction = 1u << 31;
	for (uint32_t index = p_index; index != 0; index >>= 1) {
		if ((index & 1u) != 0) {
			result ^= direction;
		}
		direction ^= direction >> 1;
	}
	return result;
}

/// Owen's nested scramble by a hash, Burley 2020, listing 3.
uint32_t scramble_nested(uint32_t p_value, uint32_t p_seed) {
	uint32_t value = reverse_bits(p_value);
	value += p_seed;
	value ^= value * 0x6c50b47cu;
	value ^= value * 0xb82f1e52u;
	value ^= value * 0xc7afe638u;
	value ^= value * 0x8d22f6e6u;
	return reverse_bits(value);
}

/// Inserts a 0 before each bit, for Morton codes.
uint64_t spread_bits(uint32_t p_value) {
	uint64_t value = p_value;
	value = (value | (value << 16)) & 0x0000ffff0000ffffu;
	value = (value | (value << 8)) & 0x00ff00ff00ff00ffu;
	value = (value | (value << 4)) & 0x0f0f0f0f0f0f0f0fu;
	value = (value | (value << 2)) & 0x3333333333333333u;
	return (value | (value << 1)) & 0x5555555555555555u;
}

/// Converts a 32-bit fraction to the middle of its 24-bit cell, scaled to -1..1. Above 0 the middle
/// is rounded to a border of the cell, so 0 and 1 can occur.
float to_signed_unit(uint32_t p_fraction) {
	return (static_cast<float>(p_fraction >> 8) + 0.5f) * 0x1p-23f - 1.0f;
}

/// Computes the sine and cosine of (pi/4) p_q for |p_q| <= 1, with an error of 1e-7. Taylor
/// polynomials instead of library calls, because this runs once per ray.
void compute_sine_cosine(float p_q, float &r_sine, float &r_cosine) {
	const float t = p_q * 0.785398163f; // pi / 4
	const float t2 = t * t;
	r_sine = t * (1.0f + t2 * (-1.0f / 6 + t2 * (1.0f / 120 + t2 * (-1.0f / 5040 + t2 / 362880))));
	r_cosine = 1.0f + t2 * (-0.5f + t2 * (1.0f / 24 + t2 * (-1.0f / 720 + t2 / 40320)));
}

} // namespace

DiscSamples::DiscSamples(uint32_t p_count, uint64_t p_seed) : count(p_count) {
	const uint32_t seed_u = static_cast<uint32_t>(mix_bits(p_seed));
	const uint32_t seed_v = static_cast<uint32_t>(mix_bits(p_seed) >> 32);
	struct Point {
		uint64_t morton;
		uint32_t u;
		uint32_t v;
	};
	std::vector<Point> points(count);
	for (uint32_t i = 0; i < count; ++i) {
		const uint32_t u = scramble_nested(reverse_bits(i), seed_u);
		const uint32_t v = scramble_nested(compute_sobol_2(i), seed_v);
		points[i] = { spread_bits(u) | (spread_bits(v) << 1), u, v };
	}
	std::ranges::sort(points, {}, &Point::morton);
	const size_t padded = static_cast<size_t>(get_packet_count()) * PACKET_SIZE;
	for (size_t i = 0; i < padded; ++i) {
		const Point &point = points[std::min<size_t>(i, count - 1)];
		coordinates_u.push_back(point.u);
		coordinates_v.push_back(point.v);
	}
}

void DiscSamples::compute_packet(
		uint32_t p_packet, uint32_t p_scramble_u, uint32_t p_scramble_v, Packet &r_packet) const {
	const uint32_t *u = &coordinates_u[static_cast<size_t>(p_packet) * PACKET_SIZE];
	const uint32_t *v = &coordinates_v[static_cast<size_t>(p_packet) * PACKET_SIZE];
	for (uint32_t i = 0; i < PACKET_SIZE; ++i) {
		const float a = to_signed_unit(u[i] ^ p_scramble_u);
		const float b = to_signed_unit(v[i] ^ p_scramble_v);
		const bool is_wide = std::abs(a) > std::abs(b);
		const float radius = is_wide ? a : b;
		float sine = 0;
		float cosine = 0;
		// In the disc's centre, both coordinates are 0 and the quotient is not defined.
		compute_sine_cosine(radius != 0 ? (is_wide ? b : a) / radius : 0.0f, sine, cosine);
		r_packet.x[i] = radius * (is_wide ? cosine : sine);
		r_packet.y[i] = radius * (is_wide ? sine : cosine);
	}
}

} // namespace gnomon
