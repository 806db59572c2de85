// The order of a mesh's faces and edges, which makes clusters of consecutive ones compact.

#include "modules/mesh_tools/topology.h"
#include "modules/shadow_edge_count/count_mesh.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace gnomon;

TEST_CASE("[EdgeCount] consecutive edges of a mesh are in the same cell or in neighbouring ones") {
	const uint32_t CELLS = 8; // per axis
	const float SIZE = 0.05f; // of a triangle; neighbouring cells are 1 apart
	std::vector<glm::vec3> positions;
	std::vector<uint32_t> indices;
	for (uint32_t cell = 0; cell < CELLS * CELLS * CELLS; ++cell) {
		const glm::vec3 corner(cell % CELLS, cell / CELLS % CELLS, cell / CELLS / CELLS);
		for (const glm::vec3 &offset :
				{ glm::vec3(0.0f), glm::vec3(SIZE, 0.0f, 0.0f), glm::vec3(0.0f, SIZE, SIZE) }) {
			indices.push_back(static_cast<uint32_t>(positions.size()));
			positions.push_back(corner + offset);
		}
	}
	Mesh mesh;
	mesh.positions_node = positions;
	mesh.indices = indices;
	const MeshTopology topology = build_topology(mesh);
	const CountMesh counted = build_count_mesh(topology);
	REQUIRE(counted.edges.size() == indices.size());
	const auto find_middle = [&](const shader::CountMeshEdge &p_edge) {
		return 0.5f *
				(topology.welded_positions_node[p_edge.a] +
						topology.welded_positions_node[p_edge.b]);
	};
	float max_distance = 0.0f; // between the midpoints of consecutive edges
	for (size_t index = 1; index < counted.edges.size(); ++index) {
		max_distance = std::max(max_distance,
				glm::distance(
						find_middle(counted.edges[index - 1]), find_middle(counted.edges[index])));
	}
	// Edges follow a Hilbert curve; a Morton curve would jump.
	CHECK(max_distance < 1.0f + 2.0f * SIZE);
}
