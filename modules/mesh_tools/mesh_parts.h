#pragma once

#include "modules/mesh_tools/topology.h"

namespace gnomon {

/// Fills MeshTopology::parts and part_indices, and the counts of parts, from faces and edges.
void find_mesh_parts(MeshTopology &r_topology);

} // namespace gnomon
