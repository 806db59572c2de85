#include "modules/mesh_tools/convexity.h"
#include "modules/mesh_tools/tests/test_meshes.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

uint32_t count_parts(const Mesh &p_mesh) {
	return count_convex_parts(build_topology(p_mesh));
}

} // namespace

TEST_CASE("[MeshTools] count_convex_parts counts convex solids and returns 0 for any other mesh") {
	const Mesh cube = test_meshes::make_cube();
	CHECK(count_parts(cube) == 1);
	CHECK(count_parts(test_meshes::make_sphere(3)) == 1);
	CHECK(count_parts(test_meshes::join(test_meshes::make_cube({ 0.3f, 0, 0 }), cube)) == 2);
	CHECK(count_parts(test_meshes::make_quad()) == 0);
	CHECK(count_parts(test_meshes::make_moebius(12)) == 0);
	Mesh dented = test_meshes::make_sphere(2);
	dented.positions_node[5] *= 0.5f;
	CHECK(count_parts(dented) == 0);
	Mesh inside_out = cube;
	for (size_t first = 0; first < inside_out.indices.size(); first += 3) {
		std::swap(inside_out.indices[first], inside_out.indices[first + 1]);
	}
	CHECK(count_parts(inside_out) == 0);
	CHECK(count_parts(Mesh()) == 0);
}
