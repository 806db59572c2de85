#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace gnomon {

/// 64 points of the unit disc, and which of them lie beyond a line: bit k of a mask is point k.
class DiscMasks {
public:
	static constexpr uint32_t SAMPLE_COUNT = 64;
	static constexpr uint32_t DIRECTION_COUNT = 256;
	static constexpr uint32_t OFFSET_COUNT = 64;

	/// Points on a Vogel disc turned by p_turn_rad; the table is the same in C++ and on the GPU.
	explicit DiscMasks(double p_turn_rad = 0.0);

	/// Points beyond the line that is p_offset (0..1) from the centre in that direction, which need
	/// not be unit. Offset 0 is exact; others are rounded to the middles of 64 steps.
	uint64_t get_mask(const glm::dvec2 &p_direction, double p_offset) const {
		return table[size_t(find_direction(p_direction)) * OFFSET_COUNT + find_offset(p_offset)];
	}
	static uint32_t find_direction(const glm::dvec2 &p_direction);
	static uint32_t find_offset(double p_offset);
	static glm::dvec2 compute_sample(uint32_t p_index, double p_turn_rad);
	/// By direction, then by offset.
	const std::vector<uint64_t> &get_table() const { return table; }

private:
	std::vector<uint64_t> table;
};

} // namespace gnomon
