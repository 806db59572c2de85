#include "modules/mesh_tools/convexity.h"

namespace gnomon {

namespace {

const double FLATNESS_TOLERANCE = 1e-6; // sine of the largest concave angle that counts as flat

glm::dvec3 get_welded_position(const MeshTopology &p_topology, uint32_t p_vertex) {
	return p_topology.welded_positions_node[p_vertex];
}

/// Returns whether the edge is concave: whether face1 is in front of the plane of face0.
bool is_concave(const MeshTopology &p_topology, const MeshEdge &p_edge) {
	const glm::dvec3 a = get_welded_position(p_topology, p_edge.a);
	const glm::dvec3 b = get_welded_position(p_topology, p_edge.b);
	const auto find_corner = [&](uint32_t p_face) {
		return get_welded_position(
				p_topology, p_topology.find_opposite_vertex(p_face, p_edge.a, p_edge.b));
	};
	const glm::dvec3 own = find_corner(p_edge.face0) - a;
	const glm::dvec3 other = find_corner(p_edge.face1) - a;
	const glm::dvec3 normal = glm::cross(b - a, own);
	return glm::dot(normal, other) > FLATNESS_TOLERANCE * glm::length(normal) * glm::length(other);
}

} // namespace

uint32_t count_convex_parts(const MeshTopology &p_topology) {
	if (p_topology.mesh_class != MeshClass::CLOSED || p_topology.signed_volume_m3 <= 0 ||
			p_topology.is_deformable) {
		return 0;
	}
	for (const MeshEdge &edge : p_topology.edges) {
		if (!edge.is_coplanar && is_concave(p_topology, edge)) {
			return 0;
		}
	}
	return p_topology.counts.part_count;
}

} // namespace gnomon
