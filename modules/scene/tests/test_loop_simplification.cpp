// build: optimised
#include "modules/core/tests/sanitized.h"
#include "modules/scene/line_moments.h"
#include "modules/scene/loop_intersections.h"
#include "modules/scene/loop_nesting.h"
#include "modules/scene/loop_simplification.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

using namespace gnomon;

namespace {

const glm::ivec2 SIZE(40000);
const glm::ivec2 CENTER = SIZE / 2;

/// A regular polygon around CENTER whose sides have many points, starting inside a side. Each
/// coordinate is off by up to p_noise.
PolygonLoop make_polygon(
		uint32_t p_sides, double p_radius, uint32_t p_points_per_side, int p_noise) {
	std::minstd_rand random(7);
	std::uniform_int_distribution<int> uniform(-p_noise, p_noise);
	const auto get_corner = [&](uint32_t p_index) {
		const double angle = 2 * std::numbers::pi * p_index / p_sides;
		return glm::dvec2(CENTER) + p_radius * glm::dvec2(std::cos(angle), std::sin(angle));
	};
	PolygonLoop loop;
	for (uint32_t i = 0; i < p_sides * p_points_per_side; ++i) {
		const uint32_t at = i + p_points_per_side / 2;
		const double fraction = double(at % p_points_per_side) / p_points_per_side;
		const uint32_t side = at / p_points_per_side;
		const glm::dvec2 point = glm::mix(get_corner(side), get_corner(side + 1), fraction);
		const int noise_x = uniform(random);
		const int noise_y = uniform(random);
		loop.push_back(glm::ivec2(glm::round(point)) + glm::ivec2(noise_x, noise_y));
	}
	return loop;
}

/// A circle as of a contour: one point for every 45 units or so. p_is_hole: runs clockwise.
PolygonLoop make_round_loop(const glm::ivec2 &p_center, double p_radius, bool p_is_hole = false) {
	const int count = std::max(16, int(p_radius / 7));
	PolygonLoop loop;
	for (int i = 0; i < count; ++i) {
		const double angle = 2 * std::numbers::pi * (p_is_hole ? -i : i) / count;
		loop.push_back(p_center +
				glm::ivec2(glm::round(p_radius * glm::dvec2(std::cos(angle), std::sin(angle)))));
	}
	return loop;
}

PolygonLoop make_rectangle(const glm::ivec2 &p_center, const glm::ivec2 &p_half) {
	const int STEPS = 8; // points per side
	const glm::ivec2 corners[] = { -p_half, { p_half.x, -p_half.y }, p_half,
		{ -p_half.x, p_half.y } };
	PolygonLoop loop;
	for (int side = 0; side < 4; ++side) {
		for (int step = 0; step < STEPS; ++step) {
			loop.push_back(p_center +
					(corners[side] * (STEPS - step) + corners[(side + 1) % 4] * step) / STEPS);
		}
	}
	return loop;
}

/// Discs, rings and rectangles of random sizes in cells of 16 texels, which nearly fill them.
std::vector<PolygonLoop> make_shapes(uint32_t p_seed) {
	const int CELL = 16 * 256;
	std::minstd_rand random(p_seed);
	std::uniform_int_distribution<int> radius(300, CELL / 2 - 40);
	std::vector<PolygonLoop> loops;
	for (int y = 0; y < 8; ++y) {
		for (int x = 0; x < 8; ++x) {
			const glm::ivec2 center = (glm::ivec2(x, y) * 2 + 1) * (CELL / 2) + 200;
			const int size = radius(random);
			switch (random() % 3) {
				case 0:
					loops.push_back(make_round_loop(center, size));
					break;
				case 1:
					loops.push_back(make_round_loop(center, size));
					loops.push_back(make_round_loop(center, size * 0.7, /*p_is_hole=*/true));
					break;
				default: {
					const int height = radius(random);
					loops.push_back(make_rectangle(center, { size, height }));
				}
			}
		}
	}
	return loops;
}

double compute_loop_area(const PolygonLoop &p_loop) {
	int64_t twice = 0;
	for (size_t i = 0; i < p_loop.size(); ++i) {
		twice += compute_twice_signed_area(CENTER, p_loop[i], p_loop[(i + 1) % p_loop.size()]);
	}
	return double(twice) / 2;
}

} // namespace

TEST_CASE("[Loops] a noisy polygon that starts inside a side gets one point per corner") {
	for (const uint32_t sides : { 3u, 5u, 6u, 9u }) {
		CAPTURE(sides);
		const PolygonLoop loop =
				make_polygon(sides, 10000, /*p_points_per_side=*/40, /*p_noise=*/20);
		const auto simplified = simplify_loops({ loop }, /*p_tolerance=*/200, SIZE);
		REQUIRE(simplified.size() == 1);
		REQUIRE(simplified[0].size() == sides);
		CHECK(compute_loop_area(simplified[0]) ==
				doctest::Approx(compute_loop_area(loop)).epsilon(1e-4));
		for (const glm::ivec2 &point : simplified[0]) {
			double nearest = 1e9;
			for (uint32_t i = 0; i < sides; ++i) {
				const double angle = 2 * std::numbers::pi * i / sides;
				const glm::dvec2 corner =
						glm::dvec2(CENTER) + 10000.0 * glm::dvec2(std::cos(angle), std::sin(angle));
				nearest = std::min(nearest, glm::length(glm::dvec2(point) - corner));
			}
			CHECK(nearest < 60); // the noise is 20; the tolerance would allow more than 200
		}
	}
}

TEST_CASE("[Loops] a circle gets as few points as the tolerance allows, and lines near it") {
	// A chord of a circle of radius r is a tolerance t away from its arc if it spans the angle
	// 2 arccos(1 - t / r): the least number of points is 2 pi over that, rounded up.
	const double RADIUS = 10000;
	const PolygonLoop loop = make_polygon(720, RADIUS, /*p_points_per_side=*/1, /*p_noise=*/0);
	for (const int32_t tolerance : { 50, 150, 400, 1100 }) {
		CAPTURE(tolerance);
		const double span = 2 * std::acos(1 - tolerance / RADIUS);
		const size_t expected = static_cast<size_t>(std::ceil(2 * std::numbers::pi / span));
		const auto simplified = simplify_loops({ loop }, tolerance, SIZE);
		CHECK(simplified[0].size() >= expected);
		CHECK(simplified[0].size() <= expected + 1);
		CHECK(compute_loop_area(simplified[0]) ==
				doctest::Approx(compute_loop_area(loop)).epsilon(2e-4));
		// Chords have their ends on the circle. Lines that fit it cross it, so their ends are
		// outside: by 2/3 of the tolerance if the chords use all of it.
		for (const glm::ivec2 &point : simplified[0]) {
			const double distance = glm::length(glm::dvec2(point - CENTER)) - RADIUS;
			CHECK(distance > 0);
			CHECK(distance < 0.9 * tolerance);
		}
	}
}

TEST_CASE("[Loops] small shapes that are close together keep their areas at every tolerance") {
	for (int seed = 1; seed <= limit_rounds(3); ++seed) {
		for (const int32_t tolerance : { 64, 256, 512, 1024 }) {
			CAPTURE(seed);
			CAPTURE(tolerance);
			const std::vector<PolygonLoop> loops = make_shapes(uint32_t(seed));
			const auto simplified = simplify_loops(loops, tolerance, SIZE);
			REQUIRE(simplified.size() == loops.size());
			CHECK(find_intersections(simplified).empty());
			size_t point_count = 0;
			size_t before_count = 0;
			for (size_t i = 0; i < loops.size(); ++i) {
				CAPTURE(i);
				CHECK(compute_loop_area(simplified[i]) ==
						doctest::Approx(compute_loop_area(loops[i])).epsilon(0.01));
				point_count += simplified[i].size();
				before_count += loops[i].size();
			}
			// At four texels triangles and squares would do, where they do not meet.
			CHECK(point_count < (tolerance == 1024 ? 10 * loops.size() : before_count / 2));
		}
	}
}

TEST_CASE("[Loops] only loops whose fitted lines meet get more points") {
	const int32_t TOLERANCE = 1024;
	const double RADIUS = 1536; // six texels
	const PolygonLoop alone = make_round_loop(CENTER, RADIUS);
	const glm::ivec2 far(12000, 0);
	const PolygonLoop one = make_round_loop(CENTER + far, RADIUS);
	const PolygonLoop other =
			make_round_loop(CENTER + far + glm::ivec2(0, int(2 * RADIUS) + 40), RADIUS);
	const auto separate = simplify_loops({ alone }, TOLERANCE, SIZE);
	const auto simplified = simplify_loops({ alone, one, other }, TOLERANCE, SIZE);
	CHECK(simplified[0] == separate[0]);
	CHECK(simplified[1].size() + simplified[2].size() > 2 * separate[0].size());
	CHECK(find_intersections(simplified).empty());
	for (const PolygonLoop &loop : simplified) {
		CHECK(compute_loop_area(loop) == doctest::Approx(compute_loop_area(alone)).epsilon(0.004));
	}
}

TEST_CASE("[Loops] tiny and thin loops remain triangles at least") {
	const PolygonLoop tiny = { CENTER, CENTER + glm::ivec2(5, 0), CENTER + glm::ivec2(5, 5),
		CENTER + glm::ivec2(0, 5) };
	const PolygonLoop thin = { CENTER, CENTER + glm::ivec2(500, 0), CENTER + glm::ivec2(1000, 0),
		CENTER + glm::ivec2(1000, 2), CENTER + glm::ivec2(500, 3), CENTER + glm::ivec2(0, 2) };
	for (const PolygonLoop &loop : { tiny, thin }) {
		const auto simplified = simplify_loops({ loop }, /*p_tolerance=*/100, SIZE);
		CHECK(simplified[0].size() >= 3);
		CHECK(compute_loop_area(simplified[0]) > 0);
	}
}

TEST_CASE("[Loops] lines do not pass over a tiny hole or island near a border") {
	const double RADIUS = 4000;
	const int HALF = 5; // of the diagonal of a hole or island
	const int COUNT = limit_rounds(60);
	for (int i = 0; i < COUNT; ++i) {
		CAPTURE(i);
		const bool is_hole = i % 2 == 0;
		const double angle = 2 * std::numbers::pi * (i + 0.3) / COUNT;
		// Nearer to the border than the tolerance.
		const double distance = RADIUS + (is_hole ? -60 : 60);
		const glm::ivec2 at = CENTER +
				glm::ivec2(glm::round(distance * glm::dvec2(std::cos(angle), std::sin(angle))));
		PolygonLoop diamond = { at + glm::ivec2(HALF, 0), at + glm::ivec2(0, HALF),
			at - glm::ivec2(HALF, 0), at - glm::ivec2(0, HALF) };
		if (is_hole) {
			std::reverse(diamond.begin(), diamond.end());
		}
		const std::vector<PolygonLoop> loops = { make_round_loop(CENTER, RADIUS), diamond };
		const auto simplified = simplify_loops(loops, /*p_tolerance=*/1024, SIZE);
		CHECK(find_intersections(simplified).empty());
		CHECK(compute_nesting(simplified) == std::vector<int>{ 0, is_hole ? 1 : 0 });
		CHECK(!triangulate(simplified).empty());
	}
}

TEST_CASE("[LineMoments] fits lines to parts of a loop") {
	const PolygonLoop square = { { 0, 0 }, { 100, 0 }, { 100, 100 }, { 0, 100 } };
	const LineMoments moments(square);
	const FittedLine side = moments.fit(1, 2);
	CHECK(side.direction.x == doctest::Approx(0));
	CHECK(side.direction.y == doctest::Approx(1));
	CHECK(side.centroid.x == doctest::Approx(100));
	CHECK(side.square_error == doctest::Approx(0));
	// The line through (75, 25) at 45 degrees; distance squared integrates to 2 * 100^3 / 24.
	const FittedLine corner = moments.fit(0, 2);
	CHECK(corner.direction.x == doctest::Approx(std::sqrt(0.5)));
	CHECK(corner.direction.y == doctest::Approx(std::sqrt(0.5)));
	CHECK(corner.centroid.x == doctest::Approx(75));
	CHECK(corner.centroid.y == doctest::Approx(25));
	CHECK(corner.square_error == doctest::Approx(2 * 1e6 / 24));
	// Beyond the loop's end.
	const FittedLine wrapped = moments.fit(3, 4);
	CHECK(wrapped.direction.y == doctest::Approx(-1));
	CHECK(wrapped.centroid.x == doctest::Approx(0));
}
