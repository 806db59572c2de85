#pragma once

#include "modules/mesh_tools/topology.h"

namespace gnomon {

/// Returns the number of convex solids that make up the mesh: at most this many of its solids
/// overlap in any view. Returns 0 if the mesh is not closed, inside out, deformable, or if a part
/// is not convex. Only edges are tested: a surface that winds round itself twice is accepted. Edges
/// that are concave by less than 1e-6 of the size of their faces count as flat.
uint32_t count_convex_parts(const MeshTopology &p_topology);

} // namespace gnomon
