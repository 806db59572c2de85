#include "modules/mesh_tools/triangle_distance.h"
#include "modules/scene/box_mesh.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <random>

using namespace gnomon;

namespace {

/// Returns the smallest distance to many points of the triangle.
double find_distance_by_brute_force(const glm::dvec3 &p_point, const glm::dvec3 (&p_corners)[3]) {
	const int count = 200;
	double min_distance = 1e300;
	for (int i = 0; i <= count; ++i) {
		for (int j = 0; i + j <= count; ++j) {
			const glm::dvec3 on = p_corners[0] +
					(p_corners[1] - p_corners[0]) * (double(i) / count) +
					(p_corners[2] - p_corners[0]) * (double(j) / count);
			min_distance = std::min(min_distance, glm::distance(p_point, on));
		}
	}
	return min_distance;
}

} // namespace

TEST_CASE("[MeshTools] the distance to a triangle is the distance to its nearest point") {
	std::mt19937 random(7);
	std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
	const auto get_point = [&] {
		return glm::dvec3(coordinate(random), coordinate(random), coordinate(random));
	};
	for (int round = 0; round < 100; ++round) {
		const glm::dvec3 corners[3] = { get_point(), get_point(), get_point() };
		const glm::dvec3 point = get_point();
		const double distance =
				compute_triangle_distance(point, corners[0], corners[1], corners[2]);
		// The brute force points are up to 2 sqrt(3) / 200 = 0.017 apart.
		CHECK(distance ==
				doctest::Approx(find_distance_by_brute_force(point, corners)).epsilon(0.03));
	}
}

TEST_CASE("[MeshTools] the distance to a triangle without area is that to its segment or point") {
	const glm::dvec3 a(0, 0, 0);
	const glm::dvec3 b(1, 0, 0);
	CHECK(compute_triangle_distance({ 0.5, 2, 0 }, a, b, b) == 2.0);
	CHECK(compute_triangle_distance({ 3, 0, 0 }, a, 0.5 * b, b) == 2.0);
	CHECK(compute_triangle_distance({ 0, 0, 4 }, a, a, a) == 4.0);
}

TEST_CASE("[MeshTools] has_triangle_within measures the distance in world space") {
	const auto box = make_box_mesh("box", glm::vec3(1.0f));
	const glm::dmat4 transform = glm::scale(
			glm::translate(glm::dmat4(1.0), glm::dvec3(1e6, 0, 0)), glm::dvec3(1.0, 0.5, 1.0));
	const glm::dvec3 above(1e6, 0.8, 0); // 0.3 above the flattened box
	CHECK(has_triangle_within(*box, transform, above, 0.31));
	CHECK_FALSE(has_triangle_within(*box, transform, above, 0.29));
	// No face is near the centre, although the point is inside the mesh's bounds.
	CHECK_FALSE(has_triangle_within(*box, transform, { 1e6, 0, 0 }, 0.45));
}
