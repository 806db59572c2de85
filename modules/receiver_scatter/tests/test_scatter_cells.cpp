#include "receiver_scatter/receiver_scatter_shared.h"
#include "tests/shaders/kernel_fixture.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace gnomon;

namespace {

constexpr double TWO_PI = 6.283185307179586;

} // namespace

TEST_CASE("[GPU][ReceiverScatter] a disc has one ring per pixel of its radius, rounded up") {
	KernelFixture fixture;
	// s, ring, sector, number of sectors
	const std::vector<glm::vec4> input = { { 0.15f, 0, 0, 6 }, { 0.5f, 0, 0, 6 }, { 0.8f, 0, 0, 6 },
		{ 1.0f, 0, 0, 6 }, { 0.01f, 0, 0, 6 }, { 0.51f, 0, 0, 6 } };
	const std::vector<glm::vec4> results =
			fixture.run("scatter_cells.comp", input, input.size(), /*p_output_per_item=*/1);
	const float expected[] = { 3, 8, 13, 16, 1, 9 };
	for (size_t i = 0; i < input.size(); ++i) {
		CAPTURE(input[i].x);
		CHECK(results[i].w == expected[i]);
	}
}

TEST_CASE("[GPU][ReceiverScatter] a cell's point is in the cell, and its weight falls outwards") {
	KernelFixture fixture;
	for (const float scatter : { 0.15f, 0.5f, 0.8f }) {
		for (const int sector_count : { 6, 15 }) {
			CAPTURE(scatter);
			CAPTURE(sector_count);
			const float radius_px = SCATTER_RADIUS_PX * scatter;
			const int ring_count = static_cast<int>(std::ceil(radius_px));
			std::vector<glm::vec4> input;
			for (int ring = 0; ring < ring_count; ++ring) {
				for (int sector = 0; sector < sector_count; ++sector) {
					input.push_back({ scatter, ring, sector, sector_count });
				}
			}
			const std::vector<glm::vec4> results =
					fixture.run("scatter_cells.comp", input, input.size(), /*p_output_per_item=*/1);
			double across_sum = 0;
			for (size_t i = 0; i < input.size(); ++i) {
				// Position of the point in its cell: across the ring and along it, 0..1 each.
				const double distance = std::hypot(results[i].x, results[i].y);
				const double across = distance / radius_px * ring_count - input[i].y;
				double angle_fraction = std::atan2(results[i].y, results[i].x) / TWO_PI;
				angle_fraction += angle_fraction < 0 ? 1 : 0;
				const double along = angle_fraction * sector_count - input[i].z;
				CHECK(across > -1e-3);
				CHECK(across < 1.001);
				// Near the centre, rounding may move a point into another sector.
				CHECK((distance < 1e-3 || (along > -1e-3 && along < 1.001)));
				CHECK(results[i].z ==
						doctest::Approx(std::exp(-SCATTER_FALLOFF * distance / radius_px)));
				across_sum += across;
			}
			CHECK(across_sum / double(input.size()) == doctest::Approx(0.5).epsilon(0.15));
		}
	}
}
