#include "modules/mesh_tools/mesh_parts.h"

#include "modules/mesh_tools/face_sets.h"

namespace gnomon {

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
