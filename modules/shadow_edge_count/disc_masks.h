#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace gnomon {

/// 64 sample points of the unit disc, and a table of half-plane coverage masks: which points lie
/// beyond a line, by the line's direction and its offset from the centre. Bit k of a mask is point
/// k.
class DiscMasks {
public:
	static constexpr uint32_t SAMPLE_COUNT = 64;
	static constexpr uint32_t DIRECTION_COUNT = 256;
	static constexpr uint32_t OFFSET_COUNT = 64;

	/// Uses a Hammersley set of N = 64 * p_turn_count points: point i has the angle
	/// 2 pi (i + 0.5) / N and the radius sqrt(radical inverse of i in base 2, plus 0.5 / N). Holds
	/// the points i = p_turn + k * p_turn_count, k = 0..63. p_turn_count: a power of two.
	explicit DiscMasks(uint32_t p_turn = 0, uint32_t p_turn_count = 1);

	glm::dvec2 compute_sample(uint32_t p_index) const;
	/// The mask of the points with dot(point, direction) > offset, at index
	/// direction * OFFSET_COUNT + offset. Directions are bins of the diamond angle (see
	/// count_masks_inc.glsl). Offset 0 is exact; the others are the centres of 64 steps of 0..1.
	const std::vector<uint64_t> &get_table() const { return table; }

private:
	uint32_t turn = 0;
	uint32_t turn_count = 1;
	std::vector<uint64_t> table;
};

} // namespace gnomon
