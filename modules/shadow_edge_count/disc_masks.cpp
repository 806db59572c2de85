#include "modules/shadow_edge_count/disc_masks.h"

#include <array>
#include <cmath>
#include <numbers>

namespace gnomon {

namespace {

/// Reverses the order of the lowest log2(p_count) bits of p_value. p_count: a power of two above
/// p_value.
uint32_t reverse_bits(uint32_t p_value, uint32_t p_count) {
	uint32_t reversed = 0;
	for (uint32_t bit = 1; bit < p_count; bit *= 2) {
		reversed = 2 * reversed + ((p_value & bit) != 0 ? 1 : 0);
	}
	return reversed;
}

/// The direction at the centre of a bin of diamond angles, not unit. A diamond angle is 0 at -y, 1
/// at +x, 2 at +y and 3 at -x, see find_count_mask_indices in count_masks_inc.glsl.
glm::dvec2 compute_bin_center(uint32_t p_bin) {
	const double angle = 4.0 * (p_bin + 0.5) / DiscMasks::DIRECTION_COUNT;
	const double x = angle < 2.0 ? 1.0 - std::abs(angle - 1.0) : std::abs(angle - 3.0) - 1.0;
	const double y = angle < 2.0 ? angle - 1.0 : 3.0 - angle;
	return { x, y };
}

} // namespace

glm::dvec2 DiscMasks::compute_sample(uint32_t p_index) const {
	const uint32_t count = SAMPLE_COUNT * sample_set_count;
	const uint32_t number = p_index * sample_set_count + sample_set;
	const double radius = std::sqrt((reverse_bits(number, count) + 0.5) / count);
	const double angle = 2.0 * std::numbers::pi * (number + 0.5) / count;
	return radius * glm::dvec2(std::cos(angle), std::sin(angle));
}

DiscMasks::DiscMasks(uint32_t p_sample_set, uint32_t p_sample_set_count) :
		sample_set(p_sample_set), sample_set_count(p_sample_set_count),
		table(size_t(DIRECTION_COUNT) * OFFSET_COUNT, 0) {
	std::array<glm::dvec2, SAMPLE_COUNT> samples;
	for (uint32_t index = 0; index < SAMPLE_COUNT; ++index) {
		samples[index] = compute_sample(index);
	}
	for (uint32_t direction = 0; direction < DIRECTION_COUNT; ++direction) {
		const glm::dvec2 unit = glm::normalize(compute_bin_center(direction));
		for (uint32_t index = 0; index < SAMPLE_COUNT; ++index) {
			const double along = glm::dot(samples[index], unit);
			for (uint32_t row = 0; row < OFFSET_COUNT; ++row) {
				const double offset = row == 0 ? 0.0 : (row + 0.5) / OFFSET_COUNT;
				const uint64_t bit = along > offset ? 1 : 0;
				table[size_t(direction) * OFFSET_COUNT + row] |= bit << index;
			}
		}
	}
}

} // namespace gnomon
