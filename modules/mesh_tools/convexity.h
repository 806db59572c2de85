#pragma once

#include "modules/mesh_tools/topology.h"

namespace gnomon {

/// Of how many convex solids the mesh consists: at most so many of its solids overlap one another,
/// seen from anywhere. 0 when it is not closed, inside out, deforms, or a part is not convex. Only
/// edges are tested: a surface that winds round itself twice would pass for one. Edges that are
/// hollow by less than 1e-6 of the size of their faces count as flat.
uint32_t count_convex_parts(const MeshTopology &p_topology);

} // namespace gnomon
