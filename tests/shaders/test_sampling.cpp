#include "tests/shaders/kernel_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

TEST_CASE("[GPU][Sampling] the points of a disc are in it, evenly, and rotate with the angle") {
	KernelFixture fixture;
	for (uint32_t count : { 4u, 16u, 64u, 256u }) {
		CAPTURE(count);
		std::vector<glm::vec4> input;
		for (float angle_rad : { 0.0f, 1.0f }) {
			for (uint32_t index = 0; index < count; ++index) {
				input.emplace_back(float(index), float(count), angle_rad, 0.0f);
			}
		}
		const auto points = fixture.run("sampling.comp", input, input.size(), 1);
		glm::dvec2 mean(0.0);
		double mean_square = 0;
		for (uint32_t index = 0; index < count; ++index) {
			const glm::dvec2 point(points[index]);
			CHECK(glm::length(point) < 1.0);
			mean += point / double(count);
			mean_square += glm::dot(point, point) / count;
			const glm::dvec2 rotated(points[count + index]);
			const glm::dvec2 expected = { std::cos(1.0) * point.x - std::sin(1.0) * point.y,
				std::sin(1.0) * point.x + std::cos(1.0) * point.y };
			// The angle of the last of 256 points, 612 rad, is rounded to a multiple of 6.1e-5.
			CHECK(glm::length(rotated - expected) < 2e-4);
		}
		// For independent random points the RMS of the mean is 0.71 / sqrt(count).
		CHECK(glm::length(mean) < 1.0 / std::sqrt(double(count)));
		CHECK(mean_square == doctest::Approx(0.5)); // of the uniform disc
	}
}

TEST_CASE("[GPU][Sampling] the noise of pixels fills 0 to 1 and differs between neighbours") {
	KernelFixture fixture;
	std::vector<glm::vec4> input;
	for (uint32_t pixel = 0; pixel < 256 * 16; ++pixel) { // 16 rows, see sampling.comp
		input.emplace_back(0.0f, 1.0f, 0.0f, float(pixel));
	}
	const auto values = fixture.run("sampling.comp", input, input.size(), 1);
	std::vector<int> counts(8, 0);
	double mean_step = 0;
	for (size_t pixel = 0; pixel < values.size(); ++pixel) {
		const float value = values[pixel].z;
		REQUIRE(value >= 0.0f);
		REQUIRE(value < 1.0f);
		++counts[size_t(value * 8)];
		mean_step +=
				pixel > 0 ? std::abs(value - values[pixel - 1].z) / double(values.size()) : 0.0;
	}
	for (int count : counts) {
		CHECK(count > 400); // of 512 on average
	}
	CHECK(mean_step > 0.2); // 1/3 for independent random numbers
}
