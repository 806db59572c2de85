// The points of the light's disc (DiscMasks), and the masks of its wedges in the double version
// (DiscLookup).

#include "modules/shadow_edge_count/disc_lookup.h"

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

TEST_CASE(
		"[EdgeCount] few of 256 points are on the wrong side of an edge, about as many on either") {
	// Directions and offsets are rounded to those of the table. Points that this moves to the wrong
	// side make shadows lighter where thin shapes overlap.
	const uint32_t EDGE_COUNT = 4000;
	const uint32_t SET_COUNT = 4;
	int missing_count = 0;
	int added_count = 0;
	for (uint32_t sample_set = 0; sample_set < SET_COUNT; ++sample_set) {
		const DiscLookup masks(sample_set, SET_COUNT);
		for (uint32_t edge = 0; edge < EDGE_COUNT; ++edge) {
			// Quasi-random numbers, as above.
			const double angle = std::fmod(edge * 0.7548776662, 1.0) * 2.0 * std::numbers::pi;
			const double offset = std::fmod(edge * 0.5698402910, 1.0);
			const double half_chord = std::sqrt(1.0 - offset * offset);
			const double middle = (2.0 * std::fmod(edge * 0.8191725134, 1.0) - 1.0) * half_chord;
			const double half_length = 0.5 * std::min(0.2, half_chord - std::abs(middle));
			const glm::dvec2 direction(std::cos(angle), std::sin(angle));
			const glm::dvec2 along(-direction.y, direction.x);
			const auto at = [&](double p_along) { return offset * direction + p_along * along; };
			const uint64_t wedge =
					masks.get_wedge(at(middle - half_length), at(middle + half_length));
			const uint64_t mask = masks.get_mask(direction, offset, middle) & wedge;
			for (uint32_t index = 0; index < DiscMasks::SAMPLE_COUNT; ++index) {
				const bool is_in_wedge = (wedge >> index & 1) != 0;
				const bool is_found = (mask >> index & 1) != 0;
				const bool is_beyond =
						is_in_wedge && glm::dot(masks.compute_sample(index), direction) > offset;
				missing_count += is_beyond && !is_found ? 1 : 0;
				added_count += is_found && !is_beyond ? 1 : 0;
			}
		}
	}
	CHECK(double(missing_count + added_count) / EDGE_COUNT < 0.025);
	CHECK(std::abs(double(missing_count - added_count)) / EDGE_COUNT < 0.005);
}

} // namespace gnomon
