#include "modules/shadow_jittered_pcf/jitter_offsets.h"

#include "shadow_jittered_pcf/shadow_jittered_pcf_shared.h"

#include <glm/gtc/constants.hpp>

#include <cmath>
#include <random>

namespace gnomon {

std::vector<glm::vec4> build_jitter_offsets(uint32_t p_ring_count) {
	constexpr uint32_t SET_COUNT = JITTERED_PCF_SETS_PER_SIDE * JITTERED_PCF_SETS_PER_SIDE;
	std::mt19937 random(1); // a fixed seed
	// Uniform in [0, 1): 32 random bits divided by 2^32. std::uniform_real_distribution differs
	// between standard libraries.
	const auto next = [&] { return random() / 4294967296.0; };
	std::vector<glm::vec2> offsets;
	for (uint32_t set = 0; set < SET_COUNT; ++set) {
		for (uint32_t ring = p_ring_count; ring-- > 0;) {
			for (uint32_t tap = 0; tap < JITTERED_PCF_TAPS_PER_RING; ++tap) {
				const double u = (tap + next()) / JITTERED_PCF_TAPS_PER_RING;
				const double v = (ring + next()) / p_ring_count;
				const double angle_rad = 2 * glm::pi<double>() * u;
				offsets.emplace_back(
						std::sqrt(v) * std::cos(angle_rad), std::sqrt(v) * std::sin(angle_rad));
			}
		}
	}
	std::vector<glm::vec4> pairs;
	for (size_t i = 0; i < offsets.size(); i += 2) {
		pairs.emplace_back(offsets[i], offsets[i + 1]);
	}
	return pairs;
}

} // namespace gnomon
