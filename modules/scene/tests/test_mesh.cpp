#include "modules/core/error.h"
#include "modules/scene/mesh.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace gnomon;

namespace {

const std::vector<glm::vec3> TRIANGLE = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };

} // namespace

TEST_CASE("[Mesh] missing normals are area-weighted means of the faces' normals") {
	const auto mesh = make_mesh("a", TRIANGLE, {}, { 0, 1, 2 });
	REQUIRE(mesh->normals_node.size() == 3);
	CHECK(mesh->normals_node[1] == glm::vec3(0, 0, 1));
	CHECK(mesh->get_triangle_count() == 1);
	CHECK(mesh->bounds_node.maximum == glm::dvec3(1, 1, 0));

	// Vertex 0 is a corner of a large face towards +z and of a small one towards +y.
	const auto two =
			make_mesh("b", { { 0, 0, 0 }, { 3, 0, 0 }, { 0, 3, 0 }, { 0, 0, 1 }, { 1, 0, 0 } }, {},
					{ 0, 1, 2, 0, 3, 4 });
	CHECK(two->normals_node[0].z == doctest::Approx(9 / std::sqrt(82.0)));
	CHECK(two->normals_node[0].y == doctest::Approx(1 / std::sqrt(82.0)));
}

TEST_CASE("[Mesh] unusable normals are replaced, long ones made unit, good ones unchanged") {
	const float nan = std::numeric_limits<float>::quiet_NaN();
	const auto mesh =
			make_mesh("a", TRIANGLE, { { nan, 0, 0 }, { 0, 5, 0 }, { 0, 0, 0 } }, { 0, 1, 2 });
	CHECK(mesh->normals_node[0] == glm::vec3(0, 0, 1));
	CHECK(mesh->normals_node[1] == glm::vec3(0, 1, 0));
	CHECK(mesh->normals_node[2] == glm::vec3(0, 0, 1));
	const std::vector<glm::vec3> units(3, glm::vec3(0, 0.6f, 0.8f));
	CHECK(make_mesh("b", TRIANGLE, units, { 0, 1, 2 })->normals_node == units);
}

TEST_CASE("[Mesh] a vertex without area still has a unit normal") {
	const auto mesh = make_mesh("a", { { 1, 1, 1 }, { 1, 1, 1 }, { 1, 1, 1 } }, {}, { 0, 1, 2 });
	CHECK(glm::length(mesh->normals_node[0]) == 1.0f);
}

TEST_CASE("[Mesh] every mesh has its own id") {
	CHECK(make_mesh("a", TRIANGLE, {}, {})->id != make_mesh("a", TRIANGLE, {}, {})->id);
}

TEST_CASE("[Mesh] wrong counts, indices and positions are errors that name the mesh") {
	const float infinity = std::numeric_limits<float>::infinity();
	CHECK_THROWS_WITH_AS(make_mesh("knot", TRIANGLE, {}, { 0, 1, 3 }),
			"Mesh \"knot\": index 2 is 3, must be below 3, the number of positions. Export it "
			"again.",
			Error);
	CHECK_THROWS_WITH_AS(make_mesh("knot", TRIANGLE, {}, { 0, 1 }),
			doctest::Contains("\"knot\" has 2 indices"), Error);
	CHECK_THROWS_WITH_AS(make_mesh("knot", TRIANGLE, { { 0, 0, 1 } }, { 0, 1, 2 }),
			doctest::Contains("\"knot\" has 1 normals"), Error);
	CHECK_THROWS_WITH_AS(make_mesh("knot", { { 0, 0, 0 }, { 0, infinity, 0 } }, {}, {}),
			doctest::Contains("\"knot\": position 1 is not finite"), Error);
}
