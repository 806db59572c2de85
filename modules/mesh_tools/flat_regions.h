#pragma once

#include "modules/mesh_tools/topology.h"

#include <glm/glm.hpp>

#include <span>

namespace gnomon {

/// Returns whether two faces with these unit normals are parallel within 1e-6 rad, and not folded
/// back. False if a normal is zero.
bool are_coplanar(const glm::dvec3 &p_normal_0, const glm::dvec3 &p_normal_1);

/// Sets MeshTopology::plane_faces, and resets MeshEdge::is_coplanar of edges between two regions.
/// Earlier, it is true for edges whose faces are coplanar: a region may not extend across such an
/// edge, so that many small angles do not add up. p_unit_normals: per face, in double.
void find_flat_regions(std::span<const glm::dvec3> p_unit_normals, MeshTopology &r_topology);

} // namespace gnomon
