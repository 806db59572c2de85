#include "modules/mesh_tools/silhouette.h"

#include "modules/core/finite.h"

#include <cstdlib>

namespace gnomon {

std::vector<uint8_t> compute_light_facing(
		const MeshTopology &p_topology, const glm::dvec4 &p_light_position_node) {
	std::vector<uint8_t> is_facing(p_topology.get_face_count(), 0);
	// The negated vector is the same point, with a positive w.
	const glm::dvec4 light =
			p_light_position_node.w < 0 ? -p_light_position_node : p_light_position_node;
	for (size_t face = 0; face < is_facing.size(); ++face) {
		const FacePlane &plane = p_topology.planes[face];
		const double side = glm::dot(glm::dvec3(plane.normal), glm::dvec3(light)) +
				static_cast<double>(plane.offset_m) * light.w;
		is_facing[face] = side > 0 ? 1 : 0;
	}
	return is_facing;
}

int compute_edge_weight(const MeshEdge &p_edge, const std::vector<uint8_t> &p_is_facing) {
	int weight = p_is_facing[p_edge.face0] != 0 ? 1 : -1;
	if (p_edge.face1 != NO_FACE) {
		const int side = p_is_facing[p_edge.face1] != 0 ? 1 : -1;
		weight += p_edge.is_inconsistent ? side : -side;
	}
	return weight;
}

Silhouette build_silhouette(
		const MeshTopology &p_topology, const glm::dvec4 &p_light_position_node) {
	Silhouette silhouette;
	if (!is_finite(p_light_position_node)) {
		silhouette.is_facing.assign(p_topology.get_face_count(), 0);
		return silhouette;
	}
	silhouette.is_facing = compute_light_facing(p_topology, p_light_position_node);
	for (uint32_t i = 0; i < p_topology.edges.size(); ++i) {
		const MeshEdge &edge = p_topology.edges[i];
		const int sum = compute_edge_weight(edge, silhouette.is_facing);
		const int weight = p_topology.is_double_sided(edge.face0) ? sum : sum / 2;
		if (weight != 0) {
			silhouette.edges.push_back({ i, weight > 0 ? edge.a : edge.b,
					weight > 0 ? edge.b : edge.a, static_cast<uint32_t>(std::abs(weight)) });
		}
	}
	return silhouette;
}

} // namespace gnomon
