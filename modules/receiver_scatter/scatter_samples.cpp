#include "modules/receiver_scatter/scatter_samples.h"

#include "modules/shadows/surface_spread.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

constexpr double GOLDEN_ANGLE_RAD = 2.399963229728653;
constexpr double TWO_PI = 6.283185307179586;
constexpr uint32_t RINGS_AT_HALF_SCATTER = 8; // rings of the disc at s = 0.5

/// Reverses the bits of an index below p_count, a power of 2, so that sets with close indices use
/// distant substrata.
constexpr uint32_t reverse_bits(uint32_t p_index, uint32_t p_count) {
	uint32_t reversed = 0;
	for (uint32_t bit = 1; bit < p_count; bit *= 2) {
		reversed = 2 * reversed + ((p_index & bit) != 0 ? 1 : 0);
	}
	return reversed;
}

} // namespace

uint32_t compute_sector_count(uint32_t p_sample_count) {
	return std::max(1u, (p_sample_count + RINGS_AT_HALF_SCATTER / 2) / RINGS_AT_HALF_SCATTER);
}

std::vector<glm::vec2> make_scatter_samples(
		const SurfaceSpread &p_spread, uint32_t p_sample_count) {
	std::vector<glm::vec2> samples;
	for (const uint32_t set_count : { 1u, 4u, 16u }) {
		for (uint32_t set = 0; set < set_count; ++set) {
			const double stratum_offset = (reverse_bits(set, set_count) + 0.5) / set_count;
			for (uint32_t index = 0; index < p_sample_count; ++index) {
				const float fraction =
						static_cast<float>((index + stratum_offset) / p_sample_count);
				const double angle_rad = index * GOLDEN_ANGLE_RAD + set * TWO_PI / set_count;
				samples.push_back(p_spread.compute_distance(fraction) *
						glm::vec2(std::cos(angle_rad), std::sin(angle_rad)));
			}
		}
	}
	return samples;
}

} // namespace gnomon
