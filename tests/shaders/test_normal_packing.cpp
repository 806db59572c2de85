#include "modules/shadows/normal_packing.h"

#include "tests/shaders/kernel_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

// The error of 16 bits per coordinate with rounding to nearest. 6.37e-5 was measured.
constexpr double MAX_ERROR_RAD = 6.5e-5;

std::vector<glm::vec4> make_directions() {
	std::vector<glm::vec4> directions;
	// Axes, edges and corners of the octahedron, where its faces are folded.
	for (int x = -1; x <= 1; ++x) {
		for (int y = -1; y <= 1; ++y) {
			for (int z = -1; z <= 1; ++z) {
				if (x != 0 || y != 0 || z != 0) {
					directions.push_back(glm::vec4(glm::normalize(glm::vec3(x, y, z)), 0.0f));
				}
			}
		}
	}
	TestRandom random;
	for (int index = 0; index < 20000; ++index) {
		directions.push_back(glm::vec4(glm::vec3(random.next_unit()), 0.0f));
	}
	for (int index = 0; index < 2000; ++index) { // close to the fold z = 0
		glm::dvec3 direction = random.next_unit();
		direction.z *= 1e-5;
		directions.push_back(glm::vec4(glm::vec3(glm::normalize(direction)), 0.0f));
	}
	return directions;
}

} // namespace

TEST_CASE("[GPU][Shaders] packed normals are within 6.5e-5 rad, and C++ unpacks them alike") {
	KernelFixture fixture;
	const std::vector<glm::vec4> directions = make_directions();
	const std::vector<glm::vec4> results =
			fixture.run("normal_packing.comp", directions, directions.size(), 2);
	double largest_error_rad = 0;
	float largest_difference = 0;
	for (size_t index = 0; index < directions.size(); ++index) {
		const glm::dvec3 expected(directions[index]);
		const glm::vec3 unpacked(results[2 * index]);
		const glm::dvec3 value(unpacked);
		const double error_rad =
				std::atan2(glm::length(glm::cross(expected, value)), glm::dot(expected, value));
		largest_error_rad = std::max(largest_error_rad, error_rad);
		const glm::vec4 &halves = results[2 * index + 1];
		const uint32_t packed =
				static_cast<uint32_t>(halves.x) | static_cast<uint32_t>(halves.y) << 16;
		const glm::vec3 difference = glm::abs(unpack_normal(packed) - unpacked);
		largest_difference =
				std::max({ largest_difference, difference.x, difference.y, difference.z });
	}
	CHECK(largest_error_rad < MAX_ERROR_RAD);
	CHECK(largest_difference < 2e-7f); // the last bit of a division or square root
}
