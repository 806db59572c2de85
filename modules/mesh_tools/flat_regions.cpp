#include "modules/mesh_tools/flat_regions.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace gnomon {

namespace {

/// Largest sine between coplanar faces: about the error of a flat quad that was rotated in float.
constexpr double COPLANAR_SINE = 1e-6;

/// The height of a face above its longest side, in metres.
double compute_height_m(const MeshTopology &p_topology, uint32_t p_face) {
	const uint32_t *corners = &p_topology.triangles[3 * size_t(p_face)];
	const glm::dvec3 a = p_topology.welded_positions_node[corners[0]];
	const glm::dvec3 b = p_topology.welded_positions_node[corners[1]];
	const glm::dvec3 c = p_topology.welded_positions_node[corners[2]];
	return glm::length(glm::cross(b - a, c - a)) /
			std::max({ glm::distance(a, b), glm::distance(b, c), glm::distance(c, a) });
}

/// Disjoint sets of faces (union-find with path halving). The root of a set is its face with the
/// largest height. All faces of a set are coplanar with its root.
class RegionSets {
public:
	explicit RegionSets(const MeshTopology &p_topology) :
			parents(p_topology.get_face_count()), heights_m(p_topology.get_face_count()),
			deviations(p_topology.get_face_count()) {
		std::iota(parents.begin(), parents.end(), 0u);
		for (uint32_t face = 0; face < parents.size(); ++face) {
			heights_m[face] = compute_height_m(p_topology, face);
		}
	}

	uint32_t find_root(uint32_t p_face) {
		uint32_t face = p_face;
		while (parents[face] != face) {
			parents[face] = parents[parents[face]];
			face = parents[face];
		}
		return face;
	}

	/// Joins two sets unless a face might then not be coplanar with the root. p_sine: between the
	/// two roots.
	void join(uint32_t p_root_0, uint32_t p_root_1, double p_sine) {
		const bool is_first = heights_m[p_root_0] >= heights_m[p_root_1];
		const uint32_t root = is_first ? p_root_0 : p_root_1;
		const uint32_t other = is_first ? p_root_1 : p_root_0;
		const double deviation = std::max(deviations[root], deviations[other] + p_sine);
		if (deviation <= COPLANAR_SINE) {
			parents[other] = root;
			deviations[root] = deviation;
		}
	}

private:
	std::vector<uint32_t> parents;
	std::vector<double> heights_m;
	std::vector<double> deviations; // per root, upper bound of the sine between it and its faces
};

} // namespace

bool are_coplanar(const glm::dvec3 &p_normal_0, const glm::dvec3 &p_normal_1) {
	return glm::dot(p_normal_0, p_normal_1) > 0.5 && // not folded back
			glm::length(glm::cross(p_normal_0, p_normal_1)) <= COPLANAR_SINE;
}

void find_flat_regions(std::span<const glm::dvec3> p_unit_normals, MeshTopology &r_topology) {
	RegionSets sets(r_topology);
	for (const MeshEdge &edge : r_topology.edges) {
		if (edge.is_coplanar) {
			const uint32_t root0 = sets.find_root(edge.face0);
			const uint32_t root1 = sets.find_root(edge.face1);
			if (root0 != root1 && are_coplanar(p_unit_normals[root0], p_unit_normals[root1])) {
				sets.join(root0, root1,
						glm::length(glm::cross(p_unit_normals[root0], p_unit_normals[root1])));
			}
		}
	}
	r_topology.plane_faces.resize(r_topology.get_face_count());
	for (uint32_t face = 0; face < r_topology.get_face_count(); ++face) {
		r_topology.plane_faces[face] = sets.find_root(face);
	}
	for (MeshEdge &edge : r_topology.edges) {
		edge.is_coplanar = edge.is_coplanar &&
				r_topology.plane_faces[edge.face0] == r_topology.plane_faces[edge.face1];
	}
}

} // namespace gnomon
