#include "modules/shadow_edge_count/count_mesh.h"

namespace gnomon {

static_assert(NO_FACE == EDGE_COUNT_NO_FACE);

CountMesh build_count_mesh(const MeshTopology &p_topology) {
	CountMesh mesh;
	for (uint32_t face = 0; face < p_topology.get_face_count(); ++face) {
		const uint32_t *corners = &p_topology.triangles[size_t(3) * face];
		mesh.faces.emplace_back(corners[0], corners[1], corners[2], 0);
	}
	const auto add_edges = [&](bool p_is_inconsistent) {
		for (const MeshEdge &edge : p_topology.edges) {
			if (edge.is_inconsistent == p_is_inconsistent && !edge.is_coplanar) {
				mesh.edges.push_back({ edge.a, edge.b, edge.face0, edge.face1 });
			}
		}
	};
	add_edges(false);
	mesh.inconsistent_from = static_cast<uint32_t>(mesh.edges.size());
	add_edges(true);
	return mesh;
}

} // namespace gnomon
