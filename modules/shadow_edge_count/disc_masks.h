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
	/// are even, and as far from the centre as the bits of their numbers read backwards. Of
	/// these every p_turn_count-th from p_turn on. p_turn_count: a power of two.
	explicit DiscMasks(uint32_t p_turn = 0, uint32_t p_turn_count = 1);

	glm::dvec2 compute_sample(uint32_t p_index) const;
	/// By direction, then by offset of a line: the points beyond it. Offset 0 is exact, others are
	/// rounded to the middles of 64 steps.
	const std::vector<uint64_t> &get_table() const { return table; }

private:
	uint32_t turn = 0;
	uint32_t turn_count = 1;
	std::vector<uint64_t> table;
};

} // namespace gnomon
