#pragma once

#include "modules/mesh_tools/topology.h"

namespace gnomon {

/// Returns the number of convex parts of a mesh that consists only of convex closed parts. At most
/// this many parts overlap at a pixel. Returns 0 if the mesh is not closed, is inside out or
/// deformable, or if a part is not convex. Only the angles at edges are tested, so a surface that
/// intersects itself but is convex at every edge is accepted. Edges that are concave by an angle of
/// less than about 1e-6 rad count as flat.
uint32_t count_convex_parts(const MeshTopology &p_topology);

} // namespace gnomon
