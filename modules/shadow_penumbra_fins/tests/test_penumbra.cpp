#include "shadow_penumbra_fins/shadow_penumbra_fins_shared.h"
#include "tests/shaders/kernel_fixture.h"

#include <doctest/doctest.h>

#include <numbers>

using namespace gnomon;

namespace {

/// Distance, nearest and farthest of items whose penumbra depth is not tested. penumbra.comp
/// describes the input and output.
const glm::vec4 ANY_DISTANCES_M(1.0f, 0.5f, 2.0f, 0.0f);

/// Visibility as a function of theta, with the sine curve of Sun et al. 2010, section 2.1.3.
double compute_transition(double p_theta, bool p_is_outer) {
	return p_is_outer ? std::sin((p_theta - 0.5) * std::numbers::pi) * 0.7 + 0.3
					  : (1 - std::cos(p_theta * std::numbers::pi)) * 0.3;
}

} // namespace

TEST_CASE("[GPU][PenumbraFins] both transition curves are the paper's, also on the edge") {
	KernelFixture fixture;
	std::vector<glm::vec4> input;
	const int step_count = 100;
	for (int step = 0; step <= step_count; ++step) {
		const float theta = float(step) / step_count;
		for (float curve : { float(FINS_CURVE_SINE), float(FINS_CURVE_LINEAR) }) {
			input.emplace_back(theta, theta >= 0.5f ? 1.0f : 0.0f, curve, 0.0f);
			input.push_back(ANY_DISTANCES_M);
		}
	}
	const auto results = fixture.run("penumbra.comp", input, input.size() / 2, 1);
	for (size_t item = 0; item < results.size(); ++item) {
		const double theta = input[2 * item].x;
		const bool is_linear = input[2 * item].z == float(FINS_CURVE_LINEAR);
		const double expected = is_linear ? theta : compute_transition(theta, theta >= 0.5);
		CHECK(results[item].x == doctest::Approx(expected).epsilon(1e-5));
		CHECK(results[item].z == doctest::Approx(is_linear ? 0.5 : 0.3));
	}
}

TEST_CASE("[GPU][PenumbraFins] without an inner half the outer one rises from 0 to 1") {
	KernelFixture fixture;
	for (float curve : { float(FINS_CURVE_SINE), float(FINS_CURVE_LINEAR) }) {
		const std::vector<glm::vec4> input = { { 0.5f, 1, curve, 1 }, ANY_DISTANCES_M,
			{ 1.0f, 1, curve, 1 }, ANY_DISTANCES_M };
		const auto results = fixture.run("penumbra.comp", input, 2, 1);
		CHECK(results[0].x == doctest::Approx(0.0));
		CHECK(results[1].x == doctest::Approx(1.0));
	}
}

TEST_CASE("[GPU][PenumbraFins] any outer fin beats any inner one, and the farther of two wins") {
	KernelFixture fixture;
	TestRandom random;
	// nearest : farthest from 1:2 to 1:1e6, the limit that MIN_DISTANCE_FRACTION in fin_passes.cpp
	// sets.
	for (double ratio : { 2.0, 100.0, 1e6 }) {
		CAPTURE(ratio);
		const float nearest_m = 3.0f;
		const float farthest_m = static_cast<float>(nearest_m * ratio);
		std::vector<glm::vec4> input;
		for (int item = 0; item < 400; ++item) {
			const double fraction = random.next();
			const float distance_m = item == 0 ? nearest_m
					: item == 1				   ? farthest_m
								: static_cast<float>(nearest_m * std::pow(ratio, fraction));
			for (float is_outer : { 0.0f, 1.0f }) {
				input.emplace_back(is_outer, is_outer, 0.0f, 0.0f);
				input.emplace_back(distance_m, nearest_m, farthest_m, 0.0f);
			}
		}
		const auto results = fixture.run("penumbra.comp", input, input.size() / 2, 1);
		float max_inner = 0;
		float min_outer = 1;
		for (size_t item = 0; item < results.size(); item += 2) {
			const double distance_m = input[2 * item + 1].x;
			max_inner = std::max(max_inner, results[item].y);
			min_outer = std::min(min_outer, results[item + 1].y);
			CHECK(results[item].y > 0.0f);
			CHECK(results[item + 1].y <= 1.0f);
			// Distances that differ by rounding alone may have the same depth.
			if (item >= 2 && distance_m > input[2 * (item - 2) + 1].x * 1.0001) {
				CHECK(results[item].y > results[item - 2].y);
				CHECK(results[item + 1].y > results[item - 1].y);
			}
		}
		CHECK(max_inner < min_outer);
	}
}
