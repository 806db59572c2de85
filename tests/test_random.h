#pragma once

#include <glm/glm.hpp>

#include <cmath>
#include <cstdint>

namespace gnomon {

/// Generates the same sequence of random numbers in every run, on every machine.
class TestRandom {
public:
	/// Returns a number in 0..1, without 1, from the upper 53 bits of Knuth's MMIX generator.
	double next() {
		state = state * 6364136223846793005ull + 1442695040888963407ull;
		return static_cast<double>(state >> 11) / 9007199254740992.0; // 2^53
	}
	double next(double p_low, double p_high) { return p_low + (p_high - p_low) * next(); }
	/// Returns a direction, evenly distributed over the unit sphere.
	glm::dvec3 next_unit() {
		const double z = next(-1, 1);
		const double angle_rad = next(0, 2 * 3.141592653589793);
		const double ring = std::sqrt(1 - z * z);
		return { ring * std::cos(angle_rad), ring * std::sin(angle_rad), z };
	}

private:
	uint64_t state = 1;
};

} // namespace gnomon
