#include "modules/mesh_tools/ray_tree.h"
#include "modules/scene/box_mesh.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace gnomon;

TEST_CASE("[RayTree] a ray hits the near side of a box, or the far side if it starts inside") {
	const RayTree tree(make_box_mesh("box", glm::vec3(1.0f, 2.0f, 3.0f)));
	const std::optional<double> outside = tree.find_nearest({ 0.1, 0.2, 10.0 }, { 0.0, 0.0, -2.0 });
	REQUIRE(outside);
	CHECK(*outside == doctest::Approx(3.5)); // in units of the direction
	const std::optional<double> inside = tree.find_nearest({ 0.1, 0.2, 0.3 }, { 0.0, -1.0, 0.0 });
	REQUIRE(inside);
	CHECK(*inside == doctest::Approx(2.2));
	// Hits before p_begin are ignored.
	const std::optional<double> after_begin =
			tree.find_nearest({ 0.1, 0.2, 10.0 }, { 0.0, 0.0, -1.0 }, 7.5);
	REQUIRE(after_begin);
	CHECK(*after_begin == doctest::Approx(13.0));
	CHECK(!tree.find_nearest({ 0.1, 0.2, 10.0 }, { 0.0, 0.0, 1.0 }));
	CHECK(!tree.find_nearest({ 1.1, 0.2, 10.0 }, { 0.0, 0.0, -1.0 }));
}

TEST_CASE("[RayTree] an invalid ray and a ray to an empty mesh hit nothing") {
	const RayTree tree(make_box_mesh("box", glm::vec3(1.0f)));
	const double nan = std::numeric_limits<double>::quiet_NaN();
	CHECK(!tree.find_nearest({ 0.0, 0.0, 5.0 }, { 0.0, 0.0, 0.0 }));
	CHECK(!tree.find_nearest({ 0.0, 0.0, 5.0 }, { 0.0, 0.0, nan }));
	CHECK(!tree.find_nearest({ nan, 0.0, 5.0 }, { 0.0, 0.0, -1.0 }));
	CHECK(!RayTree(make_mesh("empty", {}, {}, {})).find_nearest({ 0, 0, 5 }, { 0, 0, -1 }));
}

TEST_CASE("[RayTree] the nearest hit is the same as by brute force over all triangles") {
	std::mt19937 random(7);
	std::uniform_real_distribution<float> coordinate(-1.0f, 1.0f);
	std::vector<glm::vec3> positions;
	std::vector<uint32_t> indices;
	for (uint32_t index = 0; index < 3 * 200; ++index) {
		positions.push_back({ coordinate(random), coordinate(random), coordinate(random) });
		indices.push_back(index);
	}
	const auto mesh = make_mesh("soup", positions, {}, indices);
	const RayTree tree(mesh);
	int hit_count = 0;
	for (int ray = 0; ray < 300; ++ray) {
		const glm::dvec3 origin(
				3.0 * coordinate(random), 3.0 * coordinate(random), 3.0 * coordinate(random));
		const glm::dvec3 direction =
				0.5 * glm::dvec3(coordinate(random), coordinate(random), coordinate(random)) -
				origin;
		double nearest = std::numeric_limits<double>::infinity();
		for (uint32_t triangle = 0; triangle < mesh->get_triangle_count(); ++triangle) {
			const glm::dvec3 a(positions[3 * triangle]);
			const glm::dvec3 b(positions[3 * triangle + 1]);
			const glm::dvec3 c(positions[3 * triangle + 2]);
			const glm::dvec3 normal = glm::cross(b - a, c - a);
			const double t = glm::dot(a - origin, normal) / glm::dot(direction, normal);
			const glm::dvec3 hit = origin + t * direction;
			const bool is_inside = glm::dot(glm::cross(b - a, hit - a), normal) >= 0 &&
					glm::dot(glm::cross(c - b, hit - b), normal) >= 0 &&
					glm::dot(glm::cross(a - c, hit - c), normal) >= 0;
			nearest = is_inside && t > 0 ? std::min(nearest, t) : nearest;
		}
		const std::optional<double> found = tree.find_nearest(origin, direction);
		REQUIRE(found.has_value() == std::isfinite(nearest));
		if (found) {
			CHECK(*found == doctest::Approx(nearest).epsilon(1e-9));
			++hit_count;
		}
	}
	CHECK(hit_count > 60); // a fifth of the rays, so that hits are compared and not only misses
}
