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

	/// Points in the middle of 64 equal sectors, in the order of their angles, as far from the
	/// centre as the bits of their numbers read backwards say (Hammersley's set on a disc). p_turn:
	/// they are turned by so many sectors and as many quarters of one.
	explicit DiscMasks(uint32_t p_turn = 0);

	/// Points beyond the line that is p_offset (0..1) from the centre in that direction, which need
	/// not be unit. Offset 0 is exact; others are rounded to the middles of 64 steps.
	uint64_t get_mask(const glm::dvec2 &p_direction, double p_offset) const {
		return table[size_t(find_direction(p_direction)) * OFFSET_COUNT + find_offset(p_offset)];
	}
	/// Points from one direction on to another, the way that angles grow: neighbours that share a
	/// direction share no point and leave none.
	uint64_t get_wedge(const glm::dvec2 &p_from, const glm::dvec2 &p_to) const;
	/// The first point whose angle is not below the direction's.
	static uint32_t find_sector(const glm::dvec2 &p_direction, uint32_t p_turn);
	static uint32_t find_direction(const glm::dvec2 &p_direction);
	static uint32_t find_offset(double p_offset);
	static glm::dvec2 compute_sample(uint32_t p_index, uint32_t p_turn);
	/// By direction, then by offset.
	const std::vector<uint64_t> &get_table() const { return table; }

private:
	uint32_t turn = 0;
	std::vector<uint64_t> table;
};

} // namespace gnomon
