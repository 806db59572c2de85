#include "modules/scene/diagonal_flips.h"
#include "modules/scene/polygon_triangulation.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <set>
#include <utility>

using namespace gnomon;

namespace {

/// Returns the sum of the lengths of the triangles' sides; a diagonal counts twice.
double compute_length(std::span<const glm::ivec2> p_points, std::span<const uint32_t> p_triangles) {
	double length = 0;
	for (size_t side = 0; side < p_triangles.size(); ++side) {
		const size_t next = side - side % 3 + (side + 1) % 3;
		length += glm::length(
				glm::dvec2(p_points[p_triangles[side]]) - glm::dvec2(p_points[p_triangles[next]]));
	}
	return length;
}

/// Returns twice the sum of the triangles' areas. Checks that each has an area, and that no side is
/// in two triangles in the same direction.
int64_t check_triangles(
		std::span<const glm::ivec2> p_points, std::span<const uint32_t> p_triangles) {
	int64_t sum = 0;
	std::set<std::pair<uint32_t, uint32_t>> sides;
	for (size_t i = 0; i < p_triangles.size(); i += 3) {
		const uint32_t corners[] = { p_triangles[i], p_triangles[i + 1], p_triangles[i + 2] };
		const int64_t signed_area = compute_twice_signed_area(
				p_points[corners[0]], p_points[corners[1]], p_points[corners[2]]);
		CHECK(signed_area > 0);
		sum += signed_area;
		for (int corner = 0; corner < 3; ++corner) {
			CHECK(sides.insert({ corners[corner], corners[(corner + 1) % 3] }).second);
		}
	}
	return sum;
}

/// Points of a circle, in counterclockwise order.
PolygonLoop make_circle(uint32_t p_count, double p_radius) {
	PolygonLoop loop;
	for (uint32_t i = 0; i < p_count; ++i) {
		const double angle = 2 * 3.14159265358979 * i / p_count;
		loop.push_back(
				glm::ivec2(glm::round(p_radius * glm::dvec2(std::cos(angle), std::sin(angle)))));
	}
	return loop;
}

} // namespace

TEST_CASE("[DiagonalFlips] the longer diagonal of a convex quadrilateral is flipped") {
	const PolygonLoop points = { { 0, 0 }, { 8, -1 }, { 16, 0 }, { 8, 1 } };
	std::vector<uint32_t> triangles = { 0, 1, 2, 0, 2, 3 };
	shorten_diagonals(points, triangles);
	CHECK(check_triangles(points, triangles) == 32);
	const std::set<std::set<uint32_t>> expected = { { 0, 1, 3 }, { 1, 2, 3 } };
	CHECK(std::set<std::set<uint32_t>>{ { triangles[0], triangles[1], triangles[2] },
				  { triangles[3], triangles[4], triangles[5] } } == expected);
}

TEST_CASE("[DiagonalFlips] the diagonal of a concave quadrilateral stays") {
	const PolygonLoop points = { { 0, 0 }, { 20, -8 }, { 4, 0 }, { 20, 8 } };
	std::vector<uint32_t> triangles = { 0, 1, 2, 0, 2, 3 };
	const std::vector<uint32_t> before = triangles;
	shorten_diagonals(points, triangles);
	CHECK(triangles == before);
	// Nor is a diagonal flipped if that would leave a triangle without area.
	const PolygonLoop flat = { { 0, 0 }, { 10, -3 }, { 5, 0 }, { 10, 3 }, { 10, 0 } };
	std::vector<uint32_t> flat_triangles = { 0, 1, 2, 0, 2, 3, 1, 4, 2, 4, 3, 2 };
	shorten_diagonals(flat, flat_triangles);
	CHECK(check_triangles(flat, flat_triangles) == 60);
}

TEST_CASE("[DiagonalFlips] a fan of a circle becomes shorter and covers the same area") {
	const PolygonLoop points = make_circle(64, 10000);
	std::vector<uint32_t> triangles;
	for (uint32_t i = 1; i + 1 < points.size(); ++i) {
		triangles.insert(triangles.end(), { 0, i, i + 1 });
	}
	const int64_t area = check_triangles(points, triangles);
	const double length = compute_length(points, triangles);
	shorten_diagonals(points, triangles);
	CHECK(check_triangles(points, triangles) == area);
	CHECK(compute_length(points, triangles) < 0.5 * length);
	CHECK(triangles.size() == 3 * 62);
}

TEST_CASE("[DiagonalFlips] random stars keep their area, and no flip would shorten them") {
	std::mt19937 random(5);
	for (int round = 0; round < 20; ++round) {
		PolygonLoop points = make_circle(40, 1000);
		for (glm::ivec2 &point : points) {
			const int factor = 300 + static_cast<int>(random() % 1000);
			point = point * factor / 100;
		}
		std::vector<uint32_t> triangles = triangulate(std::vector<PolygonLoop>{ points });
		REQUIRE(triangles.size() == 3 * 38);
		int64_t area = 0;
		for (size_t i = 0; i < points.size(); ++i) {
			area += compute_twice_signed_area(
					glm::ivec2(0), points[i], points[(i + 1) % points.size()]);
		}
		CHECK(check_triangles(points, triangles) == area);
		// triangulate has flipped the diagonals already.
		const std::vector<uint32_t> before = triangles;
		shorten_diagonals(points, triangles);
		CHECK(triangles == before);
	}
}
