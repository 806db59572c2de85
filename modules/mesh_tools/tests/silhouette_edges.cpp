#include "modules/mesh_tools/tests/silhouette_edges.h"

#include <utility>

namespace gnomon {

namespace {

/// Mirrors is_light_facing in silhouette_inc.glsl: the same operations in the same order, from the
/// lowest vertex on. p_ids: the face's welded vertices.
bool is_light_facing(
		const MeshTopology &p_topology, const glm::vec4 &p_light, const glm::uvec3 &p_ids) {
	const int first = p_ids.y < p_ids.x && p_ids.y < p_ids.z ? 1
			: p_ids.z < p_ids.x && p_ids.z < p_ids.y		 ? 2
															 : 0;
	const glm::vec3 p = p_topology.welded_positions_node[p_ids[first]];
	const glm::vec3 u = p_topology.welded_positions_node[p_ids[(first + 1) % 3]] - p;
	const glm::vec3 v = p_topology.welded_positions_node[p_ids[(first + 2) % 3]] - p;
	const glm::vec3 to_light = glm::vec3(p_light) - p * p_light.w;
	const float nx = u.y * v.z - u.z * v.y;
	const float ny = u.z * v.x - u.x * v.z;
	const float nz = u.x * v.y - u.y * v.x;
	return (nx * to_light.x + ny * to_light.y) + nz * to_light.z > 0.0f;
}

} // namespace

std::vector<uint32_t> find_silhouette_edges(
		const MeshTopology &p_topology, const glm::vec4 &p_light_position_node) {
	std::vector<uint32_t> found;
	for (uint32_t i = 0; i < p_topology.edges.size(); ++i) {
		const MeshEdge &edge = p_topology.edges[i];
		bool is_silhouette = edge.face1 == NO_FACE;
		if (!is_silhouette) {
			const glm::uvec3 face0 = { edge.a, edge.b,
				p_topology.find_opposite_vertex(edge.face0, edge.a, edge.b) };
			glm::uvec3 face1 = { edge.b, edge.a,
				p_topology.find_opposite_vertex(edge.face1, edge.a, edge.b) };
			if (edge.is_inconsistent) {
				std::swap(face1.x, face1.y);
			}
			is_silhouette = (is_light_facing(p_topology, p_light_position_node, face0) !=
									is_light_facing(p_topology, p_light_position_node, face1)) !=
					edge.is_inconsistent;
		}
		if (is_silhouette) {
			found.push_back(i);
		}
	}
	return found;
}

} // namespace gnomon
