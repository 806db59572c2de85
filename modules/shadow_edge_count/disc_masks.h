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

	/// Hammersley's set of 64 p_turn_count points on a disc: in the order of their angles, which
	/// are even, and as far from the centre as the bits of their numbers read backwards say. Of
	/// these every p_turn_count-th from p_turn on. p_turn_count: a power of two.
	explicit DiscMasks(uint32_t p_turn = 0, uint32_t p_turn_count = 1);

	/// Points beyond the line that is p_offset (0..1) from the centre in that direction, which need
	/// not be unit. Offset 0 is exact; others are rounded to the middles of 64 steps.
	uint64_t get_mask(const glm::dvec2 &p_direction, double p_offset) const {
		return table[size_t(find_direction(p_direction)) * OFFSET_COUNT + find_offset(p_offset)];
	}
	/// Points from one direction on to another, less than half a circle the way that angles grow:
	/// neighbours that share a direction share no point and leave none.
	uint64_t get_wedge(const glm::dvec2 &p_from, const glm::dvec2 &p_to) const;
	/// The first point whose angle is not below the direction's.
	uint32_t find_sector(const glm::dvec2 &p_direction) const;
	static uint32_t find_direction(const glm::dvec2 &p_direction);
	static uint32_t find_offset(double p_offset);
	glm::dvec2 compute_sample(uint32_t p_index) const;
	/// By direction, then by offset.
	const std::vector<uint64_t> &get_table() const { return table; }

private:
	uint32_t turn = 0;
	uint32_t turn_count = 1;
	std::vector<uint64_t> table;
};

} // namespace gnomon
