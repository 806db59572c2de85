#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace gnomon {

/// Points that cover the unit disc evenly, scrambled separately for every pixel.
///
/// The first n points of an Owen-scrambled Sobol (0,2)-sequence (Owen 1995; hash by Laine and
/// Karras 2011 as in Burley 2020). They are stratified for every n, exactly in all dyadic boxes
/// when n is a power of two; an nx x ny grid would degenerate for a prime n. A pixel's scramble
/// flips bits of both coordinates (XOR). Each point is then uniformly distributed, so the mean over
/// pixels is unbiased, and the stratification is preserved. Points are stored in Morton order, so
/// that each packet of eight is in one small cell of the disc, with any scramble. The square is
/// mapped to the disc as in Shirley, Chiu 1997.
class DiscSamples {
public:
	static constexpr uint32_t PACKET_SIZE = 8;
	struct Packet {
		alignas(32) std::array<float, PACKET_SIZE> x;
		alignas(32) std::array<float, PACKET_SIZE> y;
	};

	/// p_count: number of points, 1 or more. p_seed: selects the Owen scramble.
	DiscSamples(uint32_t p_count, uint64_t p_seed);

	uint32_t get_count() const { return count; }
	uint32_t get_packet_count() const { return (count + PACKET_SIZE - 1) / PACKET_SIZE; }
	/// Returns points 8 p_packet to 8 p_packet + 7, scrambled by XOR with p_scramble_u and
	/// p_scramble_v. Points from get_count() on repeat the last one.
	void compute_packet(uint32_t p_packet, uint32_t p_scramble_u, uint32_t p_scramble_v,
			Packet &r_packet) const;

private:
	uint32_t count = 0;
	std::vector<uint32_t> coordinates_u; // 32-bit fractions
	std::vector<uint32_t> coordinates_v;
};

/// Returns a 64-bit hash (SplitMix64, Steele et al. 2014).
constexpr uint64_t mix_bits(uint64_t p_value) {
	uint64_t value = p_value + 0x9e3779b97f4a7c15u;
	value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9u;
	value = (value ^ (value >> 27)) * 0x94d049bb133111ebu;
	return value ^ (value >> 31);
}

} // namespace gnomon
