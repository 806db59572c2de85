#include "modules/receiver_scatter/dipole_spread.h"
#include "modules/receiver_scatter/scatter_samples.h"

#include "receiver_scatter/receiver_scatter_shared.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace gnomon;

namespace {

/// Computes eq. 4 of Jensen et al. 2001 without its constant factor, independently of DipoleSpread.
/// p_r: distance in 1 / (reduced extinction coefficient).
double compute_reflectance(double p_r) {
	const double albedo = 0.98;
	const double index = 1.3;
	const double transport = std::sqrt(3 * (1 - albedo));
	const double fresnel = -1.440 / (index * index) + 0.710 / index + 0.668 + 0.0636 * index;
	const double real_depth = 1;
	const double virtual_depth = 1 + 4.0 / 3 * (1 + fresnel) / (1 - fresnel);
	double sum = 0;
	for (const double z : { real_depth, virtual_depth }) {
		const double d = std::hypot(p_r, z);
		sum += z * (1 + transport * d) * std::exp(-transport * d) / (d * d * d);
	}
	return sum;
}

/// Integrates the reflectance numerically over a ring from radius p_from to p_to, without the
/// factor 2 pi.
double integrate_reflectance(double p_from, double p_to) {
	const int STEPS = 100000;
	const double step = (p_to - p_from) / STEPS;
	double sum = 0;
	for (int i = 0; i < STEPS; ++i) {
		const double r = p_from + (i + 0.5) * step;
		sum += compute_reflectance(r) * r * step;
	}
	return sum;
}

} // namespace

TEST_CASE("[DipoleSpread] the fraction of light within a distance is the dipole's integral") {
	// 95 % of the light entered within it; in the unit of compute_reflectance. Computed
	// independently of DipoleSpread.
	const double RADIUS = 8.650856602332418;
	const double whole = integrate_reflectance(0, 300); // beyond, exp(-transport d) is below 1e-31
	for (const double distance : { 0.01, 0.1, 0.3, 0.7, 1.0, 1.6, 3.0 }) {
		CAPTURE(distance);
		CHECK(DipoleSpread::compute_fraction(distance) ==
				doctest::Approx(integrate_reflectance(0, distance * RADIUS) / whole).epsilon(1e-5));
	}
	CHECK(DipoleSpread::compute_fraction(0) == doctest::Approx(0));
	CHECK(DipoleSpread::compute_fraction(1) == doctest::Approx(0.95));
}

TEST_CASE("[DipoleSpread] compute_distance inverts the fraction within a distance") {
	const DipoleSpread spread;
	float previous = -1;
	for (float fraction = 0; fraction < 0.9995f; fraction += 0.01f) { // 0 to 0.99
		CAPTURE(fraction);
		const float distance = spread.compute_distance(fraction);
		CHECK(distance > previous);
		CHECK(DipoleSpread::compute_fraction(distance) == doctest::Approx(fraction).epsilon(2e-3));
		previous = distance;
	}
	CHECK(std::isfinite(spread.compute_distance(1)));
	CHECK(spread.compute_distance(2) == spread.compute_distance(1));
	CHECK(spread.compute_distance(-1) == spread.compute_distance(0));
}

TEST_CASE("[DipoleSpread] the radius is s times the distance, s times 16 pixels without one") {
	const DipoleSpread spread;
	CHECK(spread.compute_radius_m({ 0.5f, 0.04f }, 1.0f) == doctest::Approx(0.02f));
	CHECK(spread.compute_radius_m({ 0.5f, 0.0f }, 0.01f) == doctest::Approx(0.08f));
	CHECK(spread.compute_radius_m({ 0.0f, 0.04f }, 1.0f) == 0);
	CHECK(spread.compute_radius_m({ 3.0f, 0.04f }, 1.0f) == doctest::Approx(0.04f));
	CHECK(spread.compute_radius_m({ -1.0f, 0.04f }, 1.0f) == 0);
	const float nan = std::numeric_limits<float>::quiet_NaN();
	const float infinity = std::numeric_limits<float>::infinity();
	CHECK(spread.compute_radius_m({ nan, 0.04f }, 1.0f) == 0);
	CHECK(spread.compute_radius_m({ 1.0f, infinity }, 1.0f) == 0);
	// A distance that is NaN counts as not given: 16 pixels of 0.5 m.
	CHECK(spread.compute_radius_m({ 1.0f, nan }, 0.5f) == doctest::Approx(8.0f));
}

TEST_CASE("[ReceiverScatter] 48 samples give 6 sectors and 120 give 15, as in the paper") {
	CHECK(compute_sector_count(48) == 6);
	CHECK(compute_sector_count(120) == 15);
	CHECK(compute_sector_count(8) == 1);
	CHECK(compute_sector_count(1) == 1);
}

TEST_CASE("[ReceiverScatter] samples follow the dipole's distances and favour no direction") {
	const DipoleSpread spread;
	for (const uint32_t count : { 8u, 48u, 120u }) {
		CAPTURE(count);
		const std::vector<glm::vec2> samples = make_scatter_samples(spread, count);
		REQUIRE(samples.size() == SCATTER_SET_COUNT * count);
		for (size_t index = 0; index < samples.size(); ++index) {
			// Sample i of each set is in the i-th of `count` equal fractions of the light.
			const double cell = double(index % count);
			const double fraction =
					DipoleSpread::compute_fraction(glm::length(samples[index])) * count;
			CHECK(fraction > cell - 0.01 * count);
			CHECK(fraction < cell + 1 + 0.01 * count);
		}
		size_t first = 0;
		for (const size_t set_count : { 1, 4, 16 }) {
			CAPTURE(set_count);
			const size_t group_size = set_count * count;
			glm::dvec2 directions(0.0);
			std::vector<double> fractions;
			for (size_t index = first; index < first + group_size; ++index) {
				directions += glm::dvec2(glm::normalize(samples[index]));
				fractions.push_back(DipoleSpread::compute_fraction(glm::length(samples[index])));
			}
			// The rotated sets of a group cancel out; a single set does so only nearly, to 0.023.
			CHECK(glm::length(directions) / double(group_size) < (set_count == 1 ? 0.15 : 0.01));
			// All sets of a group together are stratified: each sample has its own distance.
			std::sort(fractions.begin(), fractions.end());
			for (size_t i = 0; i < group_size; ++i) {
				CHECK(fractions[i] ==
						doctest::Approx((double(i) + 0.5) / double(group_size)).epsilon(0.02));
			}
			first += group_size;
		}
	}
}
