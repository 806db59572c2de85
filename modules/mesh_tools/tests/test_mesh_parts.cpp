#include "modules/mesh_tools/tests/test_meshes.h"
#include "modules/mesh_tools/topology.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace gnomon;
using namespace gnomon::test_meshes;

namespace {

Mesh flip_winding(Mesh p_mesh) {
	for (size_t i = 0; i < p_mesh.indices.size(); i += 3) {
		std::swap(p_mesh.indices[i], p_mesh.indices[i + 1]);
	}
	return p_mesh;
}

/// Checks the parts against their definition, which only uses the edges.
void check_parts(const MeshTopology &p_topology) {
	REQUIRE(p_topology.part_indices.size() == p_topology.get_face_count());
	REQUIRE(p_topology.counts.part_count == p_topology.parts.size());
	std::vector<bool> is_closed(p_topology.parts.size(), true);
	for (const MeshEdge &edge : p_topology.edges) {
		const uint32_t part = p_topology.part_indices[edge.face0];
		if (edge.face1 == NO_FACE || edge.is_inconsistent) {
			is_closed[part] = false;
		}
		if (edge.face1 != NO_FACE) {
			CHECK(p_topology.part_indices[edge.face1] == part);
		}
	}
	std::vector<uint32_t> face_counts(p_topology.parts.size(), 0);
	uint32_t next_part = 0;
	for (uint32_t face = 0; face < p_topology.get_face_count(); ++face) {
		const uint32_t part = p_topology.part_indices[face];
		CHECK(part <= next_part); // ordered by their first face
		next_part = std::max(next_part, part + 1);
		++face_counts[part];
		CHECK(p_topology.is_double_sided(face) == !is_closed[part]);
	}
	uint32_t closed_count = 0;
	for (uint32_t part = 0; part < p_topology.parts.size(); ++part) {
		CHECK(p_topology.parts[part].is_closed == is_closed[part]);
		CHECK(p_topology.parts[part].face_count == face_counts[part]);
		closed_count += is_closed[part] ? 1 : 0;
	}
	CHECK(p_topology.counts.closed_part_count == closed_count);
}

} // namespace

TEST_CASE("[MeshParts] a box is a closed part of a mesh that also has an open quad") {
	Mesh mesh = join(make_cube(), make_quad());
	for (size_t i = mesh.positions_node.size() - 4; i < mesh.positions_node.size(); ++i) {
		mesh.positions_node[i] += glm::vec3(9, 0, 0);
	}
	const MeshTopology topology = build_topology(mesh);
	check_parts(topology);
	CHECK(topology.is_double_sided());
	REQUIRE(topology.counts.part_count == 2);
	CHECK(topology.counts.closed_part_count == 1);
	for (uint32_t face = 0; face < topology.get_face_count(); ++face) {
		CHECK(topology.is_double_sided(face) == (face >= 12)); // the cube has 12 faces
	}
	CHECK(topology.parts[0].signed_volume_m3 == doctest::Approx(8));
}

TEST_CASE("[MeshParts] two boxes that share an edge are two closed parts") {
	const MeshTopology topology = build_topology(join(make_cube(), make_cube({ 2, 2, 0 })));
	check_parts(topology);
	CHECK(topology.is_double_sided());
	CHECK(topology.counts.part_count == 2);
	CHECK(topology.counts.closed_part_count == 2);
}

TEST_CASE("[MeshParts] a box and its duplicate are closed parts") {
	Mesh mesh = make_cube();
	mesh.indices.insert(mesh.indices.end(), mesh.indices.begin(), mesh.indices.begin() + 36);
	const MeshTopology topology = build_topology(mesh);
	check_parts(topology);
	CHECK(topology.counts.closed_part_count == topology.counts.part_count);
	double volume_m3 = 0;
	for (const MeshPart &part : topology.parts) {
		volume_m3 += part.signed_volume_m3;
	}
	CHECK(volume_m3 == doctest::Approx(16));
}

TEST_CASE("[MeshParts] a face with the wrong winding only makes its own part open") {
	Mesh mesh = join(make_cube(), make_cube({ 5, 0, 0 }));
	std::swap(mesh.indices[0], mesh.indices[1]);
	const MeshTopology topology = build_topology(mesh);
	check_parts(topology);
	REQUIRE(topology.counts.part_count == 2);
	CHECK_FALSE(topology.parts[0].is_closed);
	CHECK(topology.parts[1].is_closed);
}

TEST_CASE("[MeshParts] a boundary only makes its own part open") {
	Mesh mesh = join(make_cube({ -5, 0, 0 }), make_sphere(2));
	mesh.indices.erase(mesh.indices.begin(), mesh.indices.begin() + 3);
	const MeshTopology topology = build_topology(mesh);
	check_parts(topology);
	REQUIRE(topology.counts.part_count == 2);
	CHECK_FALSE(topology.parts[0].is_closed);
	CHECK(topology.parts[1].is_closed);
}

TEST_CASE("[MeshParts] boxes that touch at a corner are two parts") {
	const MeshTopology topology = build_topology(join(make_cube(), make_cube({ 2, 2, 2 })));
	check_parts(topology);
	CHECK(topology.counts.closed_part_count == 2);
}

TEST_CASE("[MeshParts] each part has its own volume, which is negative if it is inside out") {
	const glm::vec3 far(1e4f, -1e4f, 1e4f); // far from the first part
	const MeshTopology topology = build_topology(join(make_cube(), flip_winding(make_cube(far))));
	check_parts(topology);
	CHECK_FALSE(topology.is_double_sided());
	REQUIRE(topology.counts.part_count == 2);
	CHECK(topology.parts[0].signed_volume_m3 == doctest::Approx(8));
	CHECK(topology.parts[1].signed_volume_m3 == doctest::Approx(-8));
}

TEST_CASE("[MeshParts] parts of random triangles match their definition; an empty mesh has none") {
	for (uint32_t seed = 0; seed < 40; ++seed) {
		CAPTURE(seed);
		check_parts(build_topology(make_soup(seed, 5 + seed, 100)));
	}
	const MeshTopology empty = build_topology(Mesh());
	check_parts(empty);
	CHECK(empty.counts.part_count == 0);
}
