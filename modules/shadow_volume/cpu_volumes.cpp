#include "modules/shadow_volume/cpu_volumes.h"

#include <cmath>

namespace gnomon {

namespace {

/// Appends vertices of one mesh's volume.
struct VolumeBuilder {
	const MeshTopology &topology;
	std::vector<glm::vec4> corners;

	void add_corner(uint32_t p_vertex, bool p_is_far) {
		corners.emplace_back(topology.welded_positions_node[p_vertex], p_is_far ? 0.0f : 1.0f);
	}
	void add_triangle(uint32_t p_a, uint32_t p_b, uint32_t p_c, bool p_is_far) {
		add_corner(p_a, p_is_far);
		add_corner(p_b, p_is_far);
		add_corner(p_c, p_is_far);
	}
	/// Adds a side from the edge to infinity. The winding of the light-facing surface runs from
	/// p_from to p_to.
	void add_side(uint32_t p_from, uint32_t p_to) {
		add_corner(p_from, false);
		add_corner(p_from, true);
		add_corner(p_to, false);
		add_corner(p_to, false);
		add_corner(p_from, true);
		add_corner(p_to, true);
	}
};

} // namespace

std::vector<glm::vec4> build_cpu_volume(const MeshTopology &p_topology,
		const glm::dvec4 &p_light_position_node, const VolumeShape &p_shape) {
	VolumeBuilder builder{ p_topology, {} };
	if (!std::isfinite(glm::dot(p_light_position_node, glm::dvec4(1.0)))) {
		return {};
	}
	const Silhouette silhouette = build_silhouette(p_topology, p_light_position_node);
	for (uint32_t face = 0; face < p_topology.get_face_count(); ++face) {
		const bool is_facing = silhouette.is_facing[face] != 0;
		const bool is_solid = p_topology.get_part(face).is_solid();
		if (!is_facing && !includes(p_shape.robust, is_solid)) {
			continue;
		}
		const uint32_t *corners = &p_topology.triangles[3 * size_t(face)];
		const uint32_t b = corners[is_facing ? 1 : 2];
		const uint32_t c = corners[is_facing ? 2 : 1];
		builder.add_triangle(corners[0], b, c, /*p_is_far=*/false);
		if (p_shape.has_far_cap) {
			builder.add_triangle(corners[0], c, b, /*p_is_far=*/true);
		}
	}
	for (const SilhouetteEdge &edge : silhouette.edges) {
		const MeshPart &part = p_topology.get_part(p_topology.edges[edge.edge_index].face0);
		// In a closed, robust part both faces of an edge have volumes, so the edge has two sides.
		// In a part that is not closed, `weight` counts both already.
		const uint32_t side_count =
				part.is_closed && includes(p_shape.robust, part.is_solid()) ? 2 : 1;
		for (uint32_t i = 0; i < edge.weight * side_count; ++i) {
			builder.add_side(edge.from, edge.to);
		}
	}
	return builder.corners;
}

} // namespace gnomon
