#pragma once

#include "modules/mesh_tools/topology.h"
#include "modules/shadow_edge_count/count_space.h"

#include <glm/glm.hpp>

#include <vector>

namespace gnomon {

/// An edge that is a silhouette from some point of the light, warped.
struct CountEdge {
	glm::dvec3 a = glm::dvec3(0.0); // (x', y', w)
	glm::dvec3 b = glm::dvec3(0.0);
	/// n and d of the faces: n.r + d = 0, n unit, above 0 in front. The second is (0, 0, 0, 0)
	/// where the edge has one face.
	glm::dvec4 plane0 = glm::dvec4(0.0);
	glm::dvec4 plane1 = glm::dvec4(0.0);
	bool has_face1 = false;
	bool is_double_sided = false; // of an open or non-manifold mesh
	int center_weight = 0;		  // as seen from the light's centre; 0: no silhouette from there

	bool is_center_silhouette() const { return center_weight != 0; }
	/// Signed weight as seen from a point r of the view.
	int compute_weight(const glm::dvec3 &p_r) const;
};

/// Edges of a mesh that may be silhouettes from a point of the light, cut off
/// before the near plane and far aside. What
/// every point of the light sees from one side is left out: on both sides of such an edge the
/// number of solids is the same.
void add_count_edges(const MeshTopology &p_topology, const glm::dmat4 &p_view_from_node,
		const CountSpace &p_space, std::vector<CountEdge> &r_edges);

/// Planes of a mesh's faces in the view, unit normals; zero for a face without area.
std::vector<glm::dvec4> compute_view_planes(
		const MeshTopology &p_topology, const glm::dmat4 &p_view_from_node);

} // namespace gnomon
