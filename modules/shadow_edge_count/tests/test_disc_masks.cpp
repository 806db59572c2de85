// The points of the light's disc (DiscMasks), and the masks of its wedges in the double version
// (DiscLookup).

#include "modules/shadow_edge_count/tests/disc_lookup.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace gnomon {

namespace {

double compute_angle_rad(const glm::dvec2 &p_direction) {
	const double angle = std::atan2(p_direction.y, p_direction.x);
	return angle < 0 ? angle + 2.0 * std::numbers::pi : angle;
}

} // namespace

TEST_CASE("[EdgeCount] each ring and each sector of the disc has exactly one point") {
	for (const uint32_t sample_set_count : { 1u, 4u }) {
		CAPTURE(sample_set_count);
		const uint32_t count = DiscMasks::SAMPLE_COUNT * sample_set_count;
		std::vector<uint32_t> rings(count, 0);
		std::vector<uint32_t> sectors(count, 0);
		for (uint32_t sample_set = 0; sample_set < sample_set_count; ++sample_set) {
			const DiscLookup masks(sample_set, sample_set_count);
			for (uint32_t index = 0; index < DiscMasks::SAMPLE_COUNT; ++index) {
				const glm::dvec2 point = masks.compute_sample(index);
				// Rings of equal area, sectors of equal angle; as many of each as points.
				++rings.at(size_t(glm::dot(point, point) * count));
				++sectors.at(size_t(compute_angle_rad(point) / (2.0 * std::numbers::pi) * count));
			}
		}
		CHECK(std::count(rings.begin(), rings.end(), 1u) == count);
		CHECK(std::count(sectors.begin(), sectors.end(), 1u) == count);
	}
}

TEST_CASE("[EdgeCount] a wedge has the points between its directions, in each sample set") {
	const double two_pi = 2.0 * std::numbers::pi;
	for (const uint32_t sample_set_count : { 1u, 4u }) {
		for (uint32_t sample_set = 0; sample_set < sample_set_count; ++sample_set) {
			CAPTURE(sample_set_count);
			CAPTURE(sample_set);
			const DiscLookup masks(sample_set, sample_set_count);
			for (uint32_t pair = 0; pair < 500; ++pair) {
				// Quasi-random numbers: multiples of 1 / g and 1 / g^2, g^3 = g + 1.
				const double from = std::fmod(pair * 0.7548776662, 1.0) * two_pi;
				// Seen from the centre, an edge spans less than half a circle.
				const double width = std::fmod(pair * 0.5698402910, 1.0) * std::numbers::pi;
				const double to = std::fmod(from + width, two_pi);
				uint64_t expected = 0;
				for (uint32_t index = 0; index < DiscMasks::SAMPLE_COUNT; ++index) {
					const double angle = compute_angle_rad(masks.compute_sample(index));
					const bool is_between =
							from <= to ? angle >= from && angle < to : angle >= from || angle < to;
					expected |= uint64_t(is_between) << index;
				}
				CHECK(masks.get_wedge({ std::cos(from), std::sin(from) },
							  { std::cos(to), std::sin(to) }) == expected);
			}
		}
	}
}

TEST_CASE("[EdgeCount] of 256 points, a line has less than 0.4 on the wrong side in the mean") {
	// Directions and offsets are rounded to those of the table. Where thin shapes overlap, the
	// points that this moves to the other side make the shadow lighter.
	const uint32_t LINE_COUNT = 2000;
	const uint32_t SET_COUNT = 4;
	uint32_t wrong_count = 0;
	for (uint32_t sample_set = 0; sample_set < SET_COUNT; ++sample_set) {
		const DiscLookup masks(sample_set, SET_COUNT);
		for (uint32_t line = 0; line < LINE_COUNT; ++line) {
			// Quasi-random numbers, as above.
			const double angle = std::fmod(line * 0.7548776662, 1.0) * 2.0 * std::numbers::pi;
			const double offset = std::fmod(line * 0.5698402910, 1.0);
			const glm::dvec2 direction(std::cos(angle), std::sin(angle));
			const uint64_t mask = masks.get_mask(direction, offset);
			for (uint32_t index = 0; index < DiscMasks::SAMPLE_COUNT; ++index) {
				const bool is_beyond = glm::dot(masks.compute_sample(index), direction) > offset;
				wrong_count += is_beyond != ((mask >> index & 1) != 0) ? 1 : 0;
			}
		}
	}
	CHECK(double(wrong_count) / LINE_COUNT < 0.4);
}

} // namespace gnomon
