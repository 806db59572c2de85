// Flat regions: faces that use one plane, so that the edges between them are no silhouettes.

#include "modules/mesh_tools/tests/sliver_meshes.h"
#include "modules/mesh_tools/tests/test_meshes.h"
#include "modules/mesh_tools/topology.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace gnomon;
using namespace gnomon::test_meshes;

namespace {

/// A cube with p_count slivers of this height.
Mesh make_cube_with_slivers(uint32_t p_count, double p_height, TestRandom &r_random) {
	const Mesh cube = make_cube();
	std::vector<glm::vec3> positions = cube.positions_node;
	std::vector<uint32_t> indices = cube.indices;
	add_slivers(p_count, p_height, r_random, positions, indices);
	return make(positions, indices);
}

/// The signed number of silhouette edges that leave each vertex, minus those that arrive. All 0 if
/// the silhouette consists of closed loops. p_is_in_front: per face, of the plane that it uses.
std::vector<int> sum_silhouettes(
		const MeshTopology &p_topology, const std::vector<bool> &p_is_in_front) {
	std::vector<int> sums(p_topology.welded_positions_node.size());
	for (const MeshEdge &edge : p_topology.edges) {
		if (edge.is_coplanar) {
			continue;
		}
		const int side0 = p_is_in_front[p_topology.plane_faces[edge.face0]] ? 1 : -1;
		const int side1 = p_is_in_front[p_topology.plane_faces[edge.face1]] ? 1 : -1;
		const int weight = side0 + (edge.is_inconsistent ? side1 : -side1);
		sums[edge.a] += weight;
		sums[edge.b] -= weight;
	}
	return sums;
}

} // namespace

TEST_CASE(
		"[Topology] each side of a cube is a flat region that uses the plane of one of its faces") {
	const MeshTopology topology = build_topology(make_cube());
	REQUIRE(topology.plane_faces.size() == 12);
	for (uint32_t face = 0; face < 12; ++face) {
		const uint32_t plane_face = topology.plane_faces[face];
		CHECK(topology.plane_faces[plane_face] == plane_face);
		CHECK(topology.planes[face].normal == topology.planes[plane_face].normal);
		CHECK(std::count(topology.plane_faces.begin(), topology.plane_faces.end(), plane_face) ==
				2);
	}
}

TEST_CASE(
		"[Topology] silhouettes are closed whatever side the planes of a mesh with slivers face") {
	TestRandom random;
	for (const double height : { 0.0, 1e-9, 1e-7, 1e-6, 1e-4, 0.1 }) {
		CAPTURE(height);
		for (int repeat = 0; repeat < 20; ++repeat) {
			const Mesh mesh = make_cube_with_slivers(24, height, random);
			const MeshTopology topology = build_topology(mesh);
			CHECK(topology.counts.boundary_edge_count == 0);
			std::vector<bool> is_in_front(topology.get_face_count());
			for (size_t face = 0; face < is_in_front.size(); ++face) {
				is_in_front[face] = random.next() < 0.5;
			}
			const std::vector<int> sums = sum_silhouettes(topology, is_in_front);
			CHECK(std::all_of(sums.begin(), sums.end(), [](int p_sum) { return p_sum == 0; }));
		}
	}
}

TEST_CASE("[Topology] a flat region uses the plane of its face with the largest height") {
	// Below the quad 0123, a sliver of height 1e-6 with the point 4, and a second quad's triangles.
	const Mesh mesh = make({ { 0, 0, 0 }, { 2, 0, 0 }, { 2, 1, 0 }, { 0, 1, 0 }, { 1, -1e-6f, 0 },
								   { 0, -3, 0 }, { 2, -3, 0 } },
			{ 0, 1, 2, 0, 2, 3, 0, 4, 1, 0, 5, 4, 4, 5, 6, 4, 6, 1 });
	const MeshTopology topology = build_topology(mesh);
	// The height of 456 above its side of length 3.2 is 1.9; that of the faces above the sliver is
	// 0.9.
	for (const uint32_t plane_face : topology.plane_faces) {
		CHECK(plane_face == 4);
	}
}

TEST_CASE("[Topology] small angles do not add up to a flat region around a curve") {
	// A strip of 2000 quads with an angle of 0.9e-6 rad from each to the next: 1.8e-3 in all.
	std::vector<glm::vec3> positions;
	std::vector<uint32_t> indices;
	glm::dvec2 point(0.0);
	for (uint32_t i = 0; i <= 2000; ++i) {
		const double angle_rad = 0.9e-6 * i;
		positions.emplace_back(point.x, point.y, 0);
		positions.emplace_back(point.x, point.y, 1);
		point += 0.01 * glm::dvec2(std::cos(angle_rad), std::sin(angle_rad));
		if (i > 0) {
			const uint32_t first = 2 * i;
			for (const uint32_t corner :
					{ first - 2, first, first + 1, first - 2, first + 1, first - 1 }) {
				indices.push_back(corner);
			}
		}
	}
	const MeshTopology topology = build_topology(make(positions, indices));
	for (uint32_t face = 0; face < topology.get_face_count(); ++face) {
		const glm::dvec3 normal = topology.planes[face].normal;
		const glm::dvec3 used = topology.planes[topology.plane_faces[face]].normal;
		CHECK(glm::length(glm::cross(normal, used)) < 1.1e-6);
	}
}
