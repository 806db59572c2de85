// build: optimised
#include "modules/scene/line_moments.h"
#include "modules/scene/loop_simplification.h"

#include <doctest/doctest.h>

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

double compute_area(const PolygonLoop &p_loop) {
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
		CHECK(compute_area(simplified[0]) == doctest::Approx(compute_area(loop)).epsilon(1e-4));
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
		CHECK(compute_area(simplified[0]) == doctest::Approx(compute_area(loop)).epsilon(2e-4));
		// Chords have their ends on the circle. Lines that fit it cross it, so their ends are
		// outside: by 2/3 of the tolerance if the chords use all of it.
		for (const glm::ivec2 &point : simplified[0]) {
			const double distance = glm::length(glm::dvec2(point - CENTER)) - RADIUS;
			CHECK(distance > 0);
			CHECK(distance < 0.9 * tolerance);
		}
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
		CHECK(compute_area(simplified[0]) > 0);
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
