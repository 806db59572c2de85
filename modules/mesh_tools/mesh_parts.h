#pragma once

#include "modules/mesh_tools/topology.h"

namespace gnomon {

/// Computes MeshTopology::parts, part_indices and the counts of parts from the faces and edges.
void find_mesh_parts(MeshTopology &r_topology);

} // namespace gnomon
