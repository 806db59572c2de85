#include "modules/mesh_tools/tests/test_meshes.h"
#include "modules/mesh_tools/topology.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <set>
#include <thread>
#include <tuple>

using namespace gnomon;
using namespace gnomon::test_meshes;

namespace {

int compute_euler_number(const MeshTopology &p_topology) {
	const std::set<uint32_t> used(p_topology.triangles.begin(), p_topology.triangles.end());
	return static_cast<int>(used.size()) - static_cast<int>(p_topology.edges.size()) +
			static_cast<int>(p_topology.get_face_count());
}

/// Checks that each half edge of each face belongs to exactly one edge, in the right direction, and
/// that counts, adjacency, normals and planes are valid.
void check_invariants(const MeshTopology &p_topology) {
	std::multiset<std::tuple<uint32_t, uint32_t, uint32_t>> expected;
	for (uint32_t half = 0; half < p_topology.triangles.size(); ++half) {
		const uint32_t next = half % 3 == 2 ? half - 2 : half + 1;
		expected.insert({ half / 3, p_topology.triangles[half], p_topology.triangles[next] });
	}
	std::multiset<std::tuple<uint32_t, uint32_t, uint32_t>> found;
	uint32_t boundary_edge_count = 0;
	uint32_t inconsistent_edge_count = 0;
	for (const MeshEdge &edge : p_topology.edges) {
		found.insert({ edge.face0, edge.a, edge.b });
		if (edge.face1 == NO_FACE) {
			++boundary_edge_count;
			CHECK_FALSE(edge.is_inconsistent);
			CHECK_FALSE(edge.is_coplanar);
		} else {
			inconsistent_edge_count += edge.is_inconsistent ? 1 : 0;
			found.insert({ edge.face1, edge.is_inconsistent ? edge.a : edge.b,
					edge.is_inconsistent ? edge.b : edge.a });
		}
	}
	CHECK(found == expected);
	CHECK(boundary_edge_count == p_topology.counts.boundary_edge_count);
	CHECK(inconsistent_edge_count == p_topology.counts.inconsistent_edge_count);
	REQUIRE(p_topology.adjacency_indices.size() == 2 * p_topology.triangles.size());
	for (uint32_t half = 0; half < p_topology.triangles.size(); ++half) {
		CHECK(p_topology.adjacency_indices[2 * half] == p_topology.triangles[half]);
		CHECK(p_topology.adjacency_indices[2 * half + 1] < p_topology.welded_positions_node.size());
	}
	for (const glm::vec3 &normal : p_topology.normals_node) {
		const float length = glm::length(normal);
		CHECK((length == 0.0f || std::abs(length - 1.0f) < 1e-5f));
	}
	for (const FacePlane &plane : p_topology.planes) {
		CHECK(std::isfinite(plane.offset_m));
		const float length = glm::length(plane.normal);
		CHECK((length == 0.0f || std::abs(length - 1.0f) < 1e-5f));
	}
}

} // namespace

TEST_CASE("[Topology] a cube is closed, with six coplanar diagonals and twelve sharp edges") {
	for (const Mesh &mesh : { make_cube(), unweld(make_cube()) }) {
		const MeshTopology topology = build_topology(mesh);
		check_invariants(topology);
		CHECK(topology.mesh_class == MeshClass::CLOSED);
		CHECK(topology.welded_positions_node.size() == 8);
		CHECK(topology.edges.size() == 18);
		CHECK(compute_euler_number(topology) == 2);
		CHECK(std::count_if(topology.edges.begin(), topology.edges.end(),
					  [](const MeshEdge &p_edge) { return p_edge.is_coplanar; }) == 6);
		CHECK(topology.signed_volume_m3 == doctest::Approx(8));
		for (uint32_t i = 0; i < 8; ++i) {
			// 1.73 where the normal is diagonal, 1.63 where one side has both triangles there.
			CHECK(glm::dot(topology.normals_node[i], topology.welded_positions_node[i]) > 1.4f);
		}
	}
}

TEST_CASE("[Topology] sphere and torus have the Euler numbers 2 and 0") {
	const MeshTopology sphere = build_topology(unweld(make_sphere(3)));
	check_invariants(sphere);
	CHECK(sphere.mesh_class == MeshClass::CLOSED);
	CHECK(compute_euler_number(sphere) == 2);
	// The vertices are on the unit sphere, so the faces enclose slightly less.
	CHECK(sphere.signed_volume_m3 == doctest::Approx(4.0 / 3 * std::numbers::pi).epsilon(0.02));
	const MeshTopology torus = build_topology(make_torus(20, 12));
	check_invariants(torus);
	CHECK(torus.mesh_class == MeshClass::CLOSED);
	CHECK(compute_euler_number(torus) == 0);
}

TEST_CASE("[Topology] a mesh that is inside out has a negative volume") {
	Mesh mesh = make_cube();
	for (size_t i = 0; i < mesh.indices.size(); i += 3) {
		std::swap(mesh.indices[i], mesh.indices[i + 1]);
	}
	CHECK(build_topology(mesh).signed_volume_m3 == doctest::Approx(-8));
}

TEST_CASE("[Topology] a quad has four boundary edges, where the adjacent face is the face itself") {
	const MeshTopology topology = build_topology(make_quad());
	check_invariants(topology);
	CHECK(topology.mesh_class == MeshClass::OPEN);
	CHECK(topology.counts.boundary_edge_count == 4);
	CHECK(compute_euler_number(topology) == 1);
	// Face 0 is 0 1 2 with boundaries 01 and 12 and the diagonal 20, whose other side is vertex 3.
	CHECK(std::vector<uint32_t>(
				  topology.adjacency_indices.begin(), topology.adjacency_indices.begin() + 6) ==
			std::vector<uint32_t>{ 0, 2, 1, 0, 2, 3 });
}

TEST_CASE("[Topology] positions of -0 and 0 are welded, but not those of 0 and the next float") {
	Mesh mesh = make_quad();
	mesh = unweld(mesh);
	mesh.positions_node[0] = glm::vec3(-0.0f, 0.0f, -0.0f);
	CHECK(build_topology(mesh).welded_positions_node.size() == 4);
	mesh.positions_node[0].x = std::numeric_limits<float>::denorm_min();
	CHECK(build_topology(mesh).welded_positions_node.size() == 5);
}

TEST_CASE("[Topology] of three faces at an edge, two are paired and one gets a boundary edge") {
	const Mesh mesh = make({ { 0, 0, 0 }, { 0, 0, 1 }, { 1, 0, 0 }, { 0, 1, 0 }, { -1, 0, 0 } },
			{ 0, 1, 2, 1, 0, 3, 1, 0, 4 });
	const MeshTopology topology = build_topology(mesh);
	check_invariants(topology);
	CHECK(topology.mesh_class == MeshClass::NON_MANIFOLD);
	CHECK(topology.counts.non_manifold_edge_count == 1);
	CHECK(topology.counts.inconsistent_edge_count == 0);
	CHECK(topology.edges.size() == 8); // six outer edges, one pair, one unpaired
	CHECK(topology.counts.boundary_edge_count == 7);
}

TEST_CASE("[Topology] two cubes that touch along an edge are separated") {
	const Mesh mesh = join(make_cube(), make_cube({ 2, 2, 0 }));
	const MeshTopology topology = build_topology(mesh);
	check_invariants(topology);
	CHECK(topology.mesh_class == MeshClass::NON_MANIFOLD);
	CHECK(topology.counts.non_manifold_edge_count == 1);
	CHECK(topology.counts.boundary_edge_count == 0);
	for (const MeshEdge &edge : topology.edges) {
		CHECK((edge.face0 < 12) == (edge.face1 < 12)); // no edge joins the first to the second
	}
}

TEST_CASE("[Topology] a mesh of two cubes that touch at one corner is closed") {
	const MeshTopology topology = build_topology(join(make_cube(), make_cube({ 2, 2, 2 })));
	CHECK(topology.welded_positions_node.size() == 15);
	CHECK(topology.mesh_class == MeshClass::CLOSED);
}

TEST_CASE("[Topology] a Moebius strip is non-manifold because of one inconsistent edge") {
	const MeshTopology topology = build_topology(make_moebius(24));
	check_invariants(topology);
	CHECK(topology.mesh_class == MeshClass::NON_MANIFOLD);
	CHECK(topology.counts.non_manifold_edge_count == 0);
	CHECK(topology.counts.inconsistent_edge_count == 1);
	CHECK(topology.counts.boundary_edge_count == 48);
	CHECK(compute_euler_number(topology) == 0);
}

TEST_CASE("[Topology] duplicate faces are counted, and paired into separate surfaces") {
	Mesh mesh = make_cube();
	mesh.indices.insert(mesh.indices.end(), mesh.indices.begin(), mesh.indices.begin() + 36);
	const MeshTopology topology = build_topology(mesh);
	check_invariants(topology);
	CHECK(topology.counts.duplicate_triangle_count == 12);
	CHECK(topology.counts.non_manifold_edge_count == 18);
	CHECK(topology.counts.inconsistent_edge_count == 0);
	CHECK(topology.edges.size() == 36);

	Mesh back_to_back = make_quad();
	back_to_back.indices.insert(back_to_back.indices.end(), { 2, 1, 0, 3, 2, 0 });
	const MeshTopology double_sided = build_topology(back_to_back);
	check_invariants(double_sided);
	CHECK(double_sided.counts.duplicate_triangle_count == 2);
	CHECK(double_sided.counts.zero_normal_count == 4); // both sides cancel
	for (const MeshEdge &edge : double_sided.edges) {
		const bool is_fold = double_sided.planes[edge.face0].normal.z !=
				double_sided.planes[edge.face1].normal.z;
		CHECK(is_fold); // each pair is the two sides of one triangle
		CHECK_FALSE(edge.is_coplanar);
	}
}

TEST_CASE("[Topology] triangles with an edge of zero length are skipped and counted") {
	Mesh mesh = make_cube();
	mesh.positions_node.push_back(mesh.positions_node[0]); // same position, other index
	mesh.indices.insert(mesh.indices.end(), { 0, 8, 3, 5, 5, 6, 7, 7, 7 });
	const MeshTopology topology = build_topology(mesh);
	check_invariants(topology);
	CHECK(topology.counts.degenerate_triangle_count == 3);
	CHECK(topology.get_face_count() == 12);
	CHECK(topology.source_triangles.back() == 11);
	CHECK(topology.mesh_class == MeshClass::CLOSED);
}

TEST_CASE("[Topology] a zero-area triangle keeps the mesh closed, has no plane and is never "
		  "coplanar") {
	// A T-junction closed by a triangle without area: the edge 01 is split at its middle, vertex 4,
	// for the triangles below it, but not for the one above.
	const Mesh mesh = make({ { 0, 0, 0 }, { 2, 0, 0 }, { 1, 1, 0 }, { 1, -1, 0 }, { 1, 0, 0 } },
			{ 0, 1, 2, 0, 3, 4, 4, 3, 1, 0, 4, 1 });
	const MeshTopology topology = build_topology(mesh);
	check_invariants(topology);
	CHECK(topology.counts.zero_area_triangle_count == 1);
	CHECK(topology.counts.boundary_edge_count == 4); // the rim only
	CHECK(topology.planes[3].normal == glm::vec3(0.0f));
	CHECK(topology.planes[3].offset_m == 0.0f);
	for (const MeshEdge &edge : topology.edges) {
		if (edge.face0 == 3 || edge.face1 == 3) {
			CHECK_FALSE(edge.is_coplanar);
		}
	}
}

TEST_CASE("[Topology] a T-junction without a filling triangle has boundary edges on both sides") {
	const Mesh mesh = make({ { 0, 0, 0 }, { 2, 0, 0 }, { 1, 1, 0 }, { 1, -1, 0 }, { 1, 0, 0 } },
			{ 0, 1, 2, 0, 3, 4, 4, 3, 1 });
	const MeshTopology topology = build_topology(mesh);
	check_invariants(topology);
	CHECK(topology.mesh_class == MeshClass::OPEN);
	CHECK(topology.counts.boundary_edge_count == 7);
	CHECK(topology.counts.zero_area_triangle_count == 0);
}

TEST_CASE("[Topology] slivers have a unit normal at every scale; a distant cube is closed") {
	for (const float scale : { 1e-15f, 1e-3f, 1.0f, 1e3f, 1e15f }) {
		const Mesh mesh = make(
				{ glm::vec3(0), glm::vec3(1, 0, 0) * scale, glm::vec3(0.5f, 1e-6f, 0) * scale },
				{ 0, 1, 2 });
		const MeshTopology topology = build_topology(mesh);
		CHECK(topology.counts.zero_area_triangle_count == 0);
		CHECK(topology.planes[0].normal == glm::vec3(0, 0, 1));
	}
	const glm::vec3 far(1e5f, -1e5f, 1e5f);
	const MeshTopology cube = build_topology(make_cube(far));
	check_invariants(cube);
	CHECK(cube.mesh_class == MeshClass::CLOSED);
	CHECK(cube.signed_volume_m3 == doctest::Approx(8));
	CHECK(std::abs(cube.planes[0].offset_m - (far.z - 1)) < 0.01f); // floats are 0.008 apart there
}

TEST_CASE("[Topology] an empty mesh is closed and has no edges") {
	for (const Mesh &mesh : { Mesh(), make({ { 0, 0, 0 }, { 1, 0, 0 } }, {}) }) {
		const MeshTopology topology = build_topology(mesh);
		CHECK(topology.mesh_class == MeshClass::CLOSED);
		CHECK(topology.edges.empty());
		CHECK(topology.adjacency_indices.empty());
		CHECK(topology.welded_from_position.size() == mesh.positions_node.size());
	}
}

TEST_CASE("[Topology] for random triangles every half edge belongs to exactly one edge") {
	for (uint32_t seed = 0; seed < 40; ++seed) {
		CAPTURE(seed);
		const MeshTopology topology = build_topology(make_soup(seed, 5 + seed, 100));
		check_invariants(topology);
		CHECK(topology.get_face_count() + topology.counts.degenerate_triangle_count == 100);
	}
}

TEST_CASE("[Topology] the cache builds a topology once for all threads and frees it later") {
	auto mesh = std::make_shared<Mesh>(make_sphere(4));
	mesh->id = 0xffff000000000001u; // not an id of make_mesh
	std::vector<std::shared_ptr<const MeshTopology>> found(8);
	{
		std::vector<std::jthread> threads;
		for (auto &slot : found) {
			threads.emplace_back([&slot, mesh] { slot = get_topology(mesh); });
		}
	}
	for (const auto &topology : found) {
		CHECK(topology == found[0]);
	}
	std::weak_ptr<const MeshTopology> watch = found[0];
	found.clear();
	CHECK_FALSE(watch.expired());
	mesh.reset();
	auto other = std::make_shared<Mesh>(make_cube());
	other->id = 0xffff000000000002u;
	CHECK(get_topology(other)->get_face_count() == 12);
	CHECK(watch.expired());
	other->id = 0;
	CHECK(get_topology(other) != get_topology(other)); // no id, not cached
}
