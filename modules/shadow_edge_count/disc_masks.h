#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace gnomon {

/// 64 sample points of the unit disc, which is the light, and a table of bit masks: which points
/// are beyond a line, for a given direction of the line's normal and distance from the centre. Bit
/// k of a mask is point k.
class DiscMasks {
public:
	static constexpr uint32_t SAMPLE_COUNT = 64;
	static constexpr uint32_t DIRECTION_COUNT = 128;
	static constexpr uint32_t OFFSET_COUNT = 256;

	/// One of p_sample_set_count sets of 64 points, which together are a Hammersley set of
	/// N = 64 * p_sample_set_count points. Point i of that set has the angle
	/// 2 pi (i + 0.5) / N and the radius sqrt(radical inverse of i in base 2, plus 0.5 / N). This
	/// set has the points i = p_sample_set + k * p_sample_set_count, k = 0..63.
	/// p_sample_set: 0 .. p_sample_set_count - 1. p_sample_set_count: a power of two.
	explicit DiscMasks(uint32_t p_sample_set = 0, uint32_t p_sample_set_count = 1);

	/// Point k of this set. p_index: k, 0..63.
	glm::dvec2 compute_sample(uint32_t p_index) const;
	/// The mask of the points with dot(point, direction) > offset, at index
	/// direction * OFFSET_COUNT + offset. Directions are bins of the diamond angle, see
	/// find_count_mask_indices in count_masks_inc.glsl. Offset 0 stands for exactly 0, offset i
	/// for (i + 0.5) / OFFSET_COUNT.
	const std::vector<uint64_t> &get_table() const { return table; }

private:
	uint32_t sample_set = 0;
	uint32_t sample_set_count = 1;
	std::vector<uint64_t> table;
};

} // namespace gnomon
