#include "modules/scene/node_transform.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

using namespace gnomon;

TEST_CASE("[NodeTransform] the maximum stretch is exact without shear, else an upper bound") {
	const glm::dmat4 rotation =
			glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(glm::dvec3(1, 2, 3)));
	CHECK(compute_max_stretch(rotation) == doctest::Approx(1));
	const glm::dmat4 scaled = glm::scale(glm::dmat4(1.0), glm::dvec3(0.5, -3, 2));
	CHECK(compute_max_stretch(rotation * scaled) == doctest::Approx(3));
	CHECK(compute_max_stretch(glm::dmat4(0.0)) == 0);
	// With shear: compared with the stretch of directions spread over the sphere (2.4 rad is the
	// golden angle).
	const glm::dmat4 sheared = scaled * rotation;
	const double stretch = compute_max_stretch(sheared);
	double largest = 0;
	for (int index = 0; index < 1000; ++index) {
		const double height = 1 - 2 * (index + 0.5) / 1000;
		const double radius = std::sqrt(1 - height * height);
		const glm::dvec3 direction(
				radius * std::cos(2.4 * index), radius * std::sin(2.4 * index), height);
		largest = std::max(largest, glm::length(glm::dmat3(sheared) * direction));
	}
	CHECK(largest > 2.9); // of 3, up to the spacing of the directions
	CHECK(stretch >= largest);
	CHECK(stretch < 1.8 * largest); // the bound is at most sqrt(3) times too large
}
