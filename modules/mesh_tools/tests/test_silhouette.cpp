#include "modules/mesh_tools/silhouette.h"
#include "modules/mesh_tools/tests/test_meshes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

using namespace gnomon;
using namespace gnomon::test_meshes;

namespace {

using DirectedEdges = std::map<std::pair<uint32_t, uint32_t>, int>;

/// Computes the silhouette from its definition, which only uses triangles: the boundary of the
/// light-facing surface (closed part), or of all triangles after those that are back-facing were
/// flipped (double-sided part). Opposite edges cancel out.
DirectedEdges find_silhouette_by_brute_force(
		const MeshTopology &p_topology, const glm::dvec4 &p_light) {
	const std::vector<uint8_t> is_facing = compute_light_facing(p_topology, p_light);
	DirectedEdges edges;
	for (uint32_t face = 0; face < p_topology.get_face_count(); ++face) {
		if (!p_topology.is_double_sided(face) && is_facing[face] == 0) {
			continue;
		}
		for (int k = 0; k < 3; ++k) {
			uint32_t from = p_topology.triangles[3 * face + k];
			uint32_t to = p_topology.triangles[3 * face + (k + 1) % 3];
			if (is_facing[face] == 0) {
				std::swap(from, to);
			}
			from < to ? ++edges[{ from, to }] : --edges[{ to, from }];
		}
	}
	std::erase_if(edges, [](const auto &p_item) { return p_item.second == 0; });
	return edges;
}

DirectedEdges sum_weights(const Silhouette &p_silhouette) {
	DirectedEdges edges;
	for (const SilhouetteEdge &edge : p_silhouette.edges) {
		const int weight = static_cast<int>(edge.weight);
		edge.from < edge.to ? edges[{ edge.from, edge.to }] += weight
							: edges[{ edge.to, edge.from }] -= weight;
	}
	std::erase_if(edges, [](const auto &p_item) { return p_item.second == 0; });
	return edges;
}

/// Checks that as many edges lead to each vertex as away from it, counted by weight.
void check_loops(const Silhouette &p_silhouette) {
	std::map<uint32_t, int> balance;
	for (const SilhouetteEdge &edge : p_silhouette.edges) {
		balance[edge.from] += static_cast<int>(edge.weight);
		balance[edge.to] -= static_cast<int>(edge.weight);
	}
	for (const auto &[vertex, sum] : balance) {
		CHECK(sum == 0);
	}
}

/// Makes special lights and random ones. Special: above the cube, in a plane of its faces, at its
/// corner and centre, at infinity (w = 0), very far, with negative w, all zero, and almost at
/// infinity.
std::vector<glm::dvec4> make_lights() {
	std::vector<glm::dvec4> lights = { { 0, 0, 5, 1 }, { 0, 0, 1, 1 }, { 1, 1, 1, 1 },
		{ 0, 0, 0, 1 }, { 0, 0, 1, 0 }, { 0.3, -0.2, 0.9, 0 }, { 1e6, 2e6, 3e5, 1 },
		{ 2, 2, 2, -1 }, { 0, 0, 0, 0 }, { -3, -3, -3, 1e-12 } };
	std::mt19937 random(7);
	std::uniform_real_distribution<double> coordinate(-4, 4);
	for (int i = 0; i < 20; ++i) {
		lights.emplace_back(coordinate(random), coordinate(random), coordinate(random), i % 2);
	}
	return lights;
}

} // namespace

TEST_CASE("[Silhouette] a cube lit from above has the outline of its top, in the top's winding") {
	const MeshTopology topology = build_topology(make_cube());
	const Silhouette silhouette = build_silhouette(topology, { 0, 0, 5, 1 });
	CHECK(silhouette.edges.size() == 4);
	for (const SilhouetteEdge &edge : silhouette.edges) {
		const glm::vec3 from = topology.welded_positions_node[edge.from];
		const glm::vec3 to = topology.welded_positions_node[edge.to];
		CHECK(from.z == 1.0f);
		CHECK(to.z == 1.0f);
		CHECK(edge.weight == 1);
		CHECK(from.x * to.y - from.y * to.x > 0); // counter-clockwise seen from the light
	}
}

TEST_CASE("[Silhouette] the edges are the boundary of the lit surface, for all lights and meshes") {
	std::vector<Mesh> meshes = { make_cube(), make_sphere(3), make_torus(20, 12), make_quad(),
		make_moebius(24), join(make_cube(), make_cube({ 2, 2, 0 })), Mesh() };
	meshes.push_back(join(make_sphere(2), make_quad()));
	meshes.push_back(make_cube());
	// Non-manifold: a duplicate of a face, and a triangle across the inside.
	meshes.back().indices.insert(meshes.back().indices.end(), { 0, 2, 3, 0, 7, 4 });
	for (uint32_t seed = 0; seed < 10; ++seed) {
		meshes.push_back(make_soup(seed, 6 + 2 * seed, 60));
	}
	for (size_t i = 0; i < meshes.size(); ++i) {
		CAPTURE(i);
		const MeshTopology topology = build_topology(meshes[i]);
		for (const glm::dvec4 &light : make_lights()) {
			CAPTURE(light.x);
			const Silhouette silhouette = build_silhouette(topology, light);
			CHECK(sum_weights(silhouette) == find_silhouette_by_brute_force(topology, light));
			check_loops(silhouette);
			for (const SilhouetteEdge &edge : silhouette.edges) {
				const uint32_t face = topology.edges[edge.edge_index].face0;
				CHECK(edge.weight <= (topology.is_double_sided(face) ? 2u : 1u));
			}
		}
	}
}

TEST_CASE("[Silhouette] an open part of a mesh does not change the silhouette of a closed part") {
	Mesh quad = make_quad();
	for (glm::vec3 &position : quad.positions_node) {
		position += glm::vec3(9, 0, 0);
	}
	const MeshTopology sphere = build_topology(make_sphere(2));
	const MeshTopology combined = build_topology(join(make_sphere(2), quad));
	for (const glm::dvec4 &light : make_lights()) {
		DirectedEdges expected = sum_weights(build_silhouette(sphere, light));
		DirectedEdges found = sum_weights(build_silhouette(combined, light));
		const uint32_t first_of_quad = uint32_t(sphere.welded_positions_node.size());
		std::erase_if(
				found, [&](const auto &p_item) { return p_item.first.first >= first_of_quad; });
		CHECK(found == expected);
	}
}

TEST_CASE("[Silhouette] compute_light_facing agrees with the triple product of the corners") {
	const Mesh mesh = make_torus(20, 12);
	const MeshTopology topology = build_topology(mesh);
	for (const glm::dvec4 &light : make_lights()) {
		const std::vector<uint8_t> is_facing = compute_light_facing(topology, light);
		const double sign = light.w < 0 ? -1 : 1;
		for (uint32_t face = 0; face < topology.get_face_count(); ++face) {
			const glm::dvec3 a = mesh.positions_node[mesh.indices[3 * face]];
			const glm::dvec3 b = mesh.positions_node[mesh.indices[3 * face + 1]];
			const glm::dvec3 c = mesh.positions_node[mesh.indices[3 * face + 2]];
			const glm::dvec3 cross = glm::cross(b - a, c - a);
			const double side = sign * glm::dot(cross, glm::dvec3(light) - light.w * a);
			// Nearer to the plane, the rounding of FacePlane to float may decide.
			if (std::abs(side) > 1e-5 * glm::length(cross) * glm::length(light)) {
				CHECK((side > 0) == (is_facing[face] != 0));
			}
		}
	}
}

TEST_CASE("[Silhouette] for a light in the plane of a face the edges are still a closed loop") {
	const MeshTopology topology = build_topology(make_cube());
	const Silhouette silhouette =
			build_silhouette(topology, { 1, 0, 5, 1 }); // plane of the side +x
	CHECK(silhouette.edges.size() == 4);
	check_loops(silhouette);
}

TEST_CASE("[Silhouette] a light inside a sphere has no silhouette") {
	CHECK(build_silhouette(build_topology(make_sphere(3)), { 0.1, 0.2, 0.1, 1 }).edges.empty());
}

TEST_CASE("[Silhouette] a quad has four edges from either side; the ridge of a roof has weight 2") {
	const MeshTopology quad = build_topology(make_quad());
	for (const double z : { 2.0, -2.0 }) {
		const Silhouette silhouette = build_silhouette(quad, { 0.2, 0.3, z, 1 });
		CHECK(silhouette.edges.size() == 4);
		CHECK(silhouette.is_facing[0] == (z > 0 ? 1 : 0));
	}
	// A roof of two triangles. For a light in front of the first and behind the second, both
	// outlines run along the ridge in the same direction.
	const MeshTopology roof = build_topology(
			make({ { 0, 0, 1 }, { 0, 1, 1 }, { 1, 0, 0 }, { -1, 0, 0 } }, { 0, 2, 1, 0, 1, 3 }));
	const Silhouette silhouette = build_silhouette(roof, { 9, 0.3, 0, 1 });
	unsigned double_count = 0;
	for (const SilhouetteEdge &edge : silhouette.edges) {
		double_count += edge.weight == 2 ? 1 : 0;
	}
	CHECK(double_count == 1);
}

TEST_CASE("[Silhouette] scaling the mesh and the light does not change the edges") {
	const MeshTopology torus = build_topology(make_torus(20, 12));
	const Silhouette expected = build_silhouette(torus, { 3, 2, 4, 1 });
	for (const float scale : { 1.0f / 1024, 1024.0f }) {
		Mesh mesh = make_torus(20, 12);
		for (glm::vec3 &position : mesh.positions_node) {
			position *= scale;
		}
		const Silhouette scaled =
				build_silhouette(build_topology(mesh), { 3 * scale, 2 * scale, 4 * scale, 1 });
		CHECK(sum_weights(scaled) == sum_weights(expected));
	}
}

TEST_CASE("[Silhouette] a light that is not finite has no silhouette") {
	const MeshTopology quad = build_topology(make_quad());
	for (const double bad :
			{ std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity() }) {
		const Silhouette silhouette = build_silhouette(quad, { bad, 0, 1, 1 });
		CHECK(silhouette.edges.empty());
		CHECK(silhouette.is_facing == std::vector<uint8_t>(2, 0));
	}
}
