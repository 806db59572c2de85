#include "modules/mesh_tools/mesh_parts.h"

#include <algorithm>
#include <numeric>

namespace gnomon {

namespace {

/// Disjoint sets of faces (union-find). The root of a set is its lowest index, so that every parent
/// comes before its children.
class FaceSets {
public:
	explicit FaceSets(uint32_t p_face_count) : parents(p_face_count) {
		std::iota(parents.begin(), parents.end(), 0u);
	}

	void join(uint32_t p_face0, uint32_t p_face1) {
		const uint32_t root0 = find_root(p_face0);
		const uint32_t root1 = find_root(p_face1);
		parents[std::max(root0, root1)] = std::min(root0, root1);
	}

	/// Assigns indices to the sets, in the order of their first face, and stores for each face the
	/// index of its set. Returns the count of sets.
	uint32_t assign_indices(std::vector<uint32_t> &r_indices) const {
		uint32_t count = 0;
		r_indices.resize(parents.size());
		for (uint32_t face = 0; face < parents.size(); ++face) {
			r_indices[face] = parents[face] == face ? count++ : r_indices[parents[face]];
		}
		return count;
	}

private:
	std::vector<uint32_t> parents;

	uint32_t find_root(uint32_t p_face) {
		while (parents[p_face] != p_face) {
			parents[p_face] = parents[parents[p_face]];
			p_face = parents[p_face];
		}
		return p_face;
	}
};

} // namespace

void find_mesh_parts(MeshTopology &r_topology) {
	FaceSets sets(r_topology.get_face_count());
	for (const MeshEdge &edge : r_topology.edges) {
		if (edge.face1 != NO_FACE) {
			sets.join(edge.face0, edge.face1);
		}
	}
	r_topology.parts.assign(sets.assign_indices(r_topology.part_indices), MeshPart());
	for (const MeshEdge &edge : r_topology.edges) {
		if (edge.face1 == NO_FACE || edge.is_inconsistent) {
			r_topology.parts[r_topology.part_indices[edge.face0]].is_closed = false;
		}
	}
	std::vector<glm::dvec3> origins(r_topology.parts.size());
	for (uint32_t face = 0; face < r_topology.get_face_count(); ++face) {
		MeshPart &part = r_topology.parts[r_topology.part_indices[face]];
		const auto get_corner = [&](uint32_t p_corner) {
			const uint32_t vertex = r_topology.triangles[3 * size_t(face) + p_corner];
			return glm::dvec3(r_topology.welded_positions_node[vertex]);
		};
		// Relative to a point of the part: far from the origin, the terms would lose precision by
		// cancellation.
		glm::dvec3 &origin = origins[r_topology.part_indices[face]];
		if (part.face_count++ == 0) {
			origin = get_corner(0);
		}
		part.signed_volume_m3 +=
				glm::dot(get_corner(0) - origin,
						glm::cross(get_corner(1) - origin, get_corner(2) - origin)) /
				6;
	}
	r_topology.counts.part_count = static_cast<uint32_t>(r_topology.parts.size());
	for (const MeshPart &part : r_topology.parts) {
		r_topology.counts.closed_part_count += part.is_closed ? 1 : 0;
	}
}

} // namespace gnomon
