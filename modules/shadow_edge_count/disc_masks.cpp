#include "modules/shadow_edge_count/disc_masks.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

const double GOLDEN_ANGLE_RAD = 2.399963229728653;

/// The middle of a bin of diamond angles, see find_direction; not unit.
glm::dvec2 compute_bin_center(uint32_t p_bin) {
	const double angle = 4.0 * (p_bin + 0.5) / DiscMasks::DIRECTION_COUNT;
	const double x = angle < 2.0 ? 1.0 - std::abs(angle - 1.0) : std::abs(angle - 3.0) - 1.0;
	const double y = angle < 2.0 ? angle - 1.0 : 3.0 - angle;
	return { x, y };
}

} // namespace

glm::dvec2 DiscMasks::compute_sample(uint32_t p_index, double p_turn_rad) {
	const double radius = std::sqrt((p_index + 0.5) / SAMPLE_COUNT);
	const double angle = GOLDEN_ANGLE_RAD * p_index + p_turn_rad;
	return radius * glm::dvec2(std::cos(angle), std::sin(angle));
}

uint32_t DiscMasks::find_direction(const glm::dvec2 &p_direction) {
	// The diamond angle y / (|x| + |y|) needs no arc tangent: 0 at -y, 1 at +x, 2 at +y, 3 at -x.
	const double sum = std::abs(p_direction.x) + std::abs(p_direction.y);
	const double share = sum > 0 ? p_direction.y / sum : 0.0;
	const double angle = p_direction.x >= 0 ? 1.0 + share : 3.0 - share;
	return static_cast<uint32_t>(angle * (DIRECTION_COUNT / 4)) % DIRECTION_COUNT;
}

uint32_t DiscMasks::find_offset(double p_offset) {
	return static_cast<uint32_t>(OFFSET_COUNT * std::clamp(p_offset, 0.0, 0.9999));
}

DiscMasks::DiscMasks(double p_turn_rad) : table(size_t(DIRECTION_COUNT) * OFFSET_COUNT, 0) {
	for (uint32_t direction = 0; direction < DIRECTION_COUNT; ++direction) {
		const glm::dvec2 unit = glm::normalize(compute_bin_center(direction));
		for (uint32_t row = 0; row < OFFSET_COUNT; ++row) {
			const double offset = row == 0 ? 0.0 : (row + 0.5) / OFFSET_COUNT;
			uint64_t &mask = table[size_t(direction) * OFFSET_COUNT + row];
			for (uint32_t index = 0; index < SAMPLE_COUNT; ++index) {
				if (glm::dot(compute_sample(index, p_turn_rad), unit) > offset) {
					mask |= uint64_t(1) << index;
				}
			}
		}
	}
}

} // namespace gnomon
