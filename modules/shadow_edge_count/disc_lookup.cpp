#include "modules/shadow_edge_count/disc_lookup.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gnomon {

namespace {

const double SECTOR_RAD = 2.0 * std::numbers::pi / DiscMasks::SAMPLE_COUNT;

} // namespace

uint32_t DiscLookup::find_sector(const glm::dvec2 &p_direction) const {
	const double angle = std::atan2(p_direction.y, p_direction.x) / SECTOR_RAD;
	// + 1 rounds up, + SAMPLE_COUNT makes it positive.
	const double position = angle + 1.0 + SAMPLE_COUNT - (sample_set + 0.5) / sample_set_count;
	return static_cast<uint32_t>(position) % SAMPLE_COUNT;
}

uint64_t DiscLookup::get_wedge(const glm::dvec2 &p_from, const glm::dvec2 &p_to) const {
	const auto before = [](uint32_t p_index) { return (uint64_t(1) << p_index) - 1; };
	const uint32_t from = find_sector(p_from);
	const uint32_t to = find_sector(p_to);
	const uint64_t between = before(from) ^ before(to);
	return from > to ? ~between : between;
}

uint64_t DiscLookup::get_mask(
		const glm::dvec2 &p_direction, double p_offset, double p_middle) const {
	// The diamond angle needs no arc tangent: 0 at -y, 1 at +x, 2 at +y, 3 at -x.
	const double sum = std::abs(p_direction.x) + std::abs(p_direction.y);
	const double ratio = p_direction.y / sum;
	const double angle = (p_direction.x >= 0 ? 1.0 + ratio : 3.0 - ratio) * (DIRECTION_COUNT / 4.0);
	const double bin = std::floor(angle);
	const double turn_rad = (bin + 0.5 - angle) * sum * sum / (DIRECTION_COUNT / 4.0);
	const double offset = std::clamp(p_offset + turn_rad * p_middle, 0.0, 0.9999);
	return get_table()[size_t(bin) % DIRECTION_COUNT * OFFSET_COUNT +
			size_t(OFFSET_COUNT * offset)];
}

} // namespace gnomon
