#pragma once

#include "modules/mesh_tools/topology.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace gnomon {

/// Finds exactly the silhouette edges that the shaders find: a C++ version of silhouette_inc.glsl
/// with the same float32 operations in the same order. Returns ascending indices into
/// MeshTopology::edges: all boundary edges, the edges between a light-facing and a back-facing
/// face, and inconsistent edges whose faces are both light-facing or both back-facing. These are
/// the edges of build_silhouette, but the two may differ where the light is, within rounding, in
/// the plane of a face.
std::vector<uint32_t> find_silhouette_edges(
		const MeshTopology &p_topology, const glm::vec4 &p_light_position_node);

} // namespace gnomon
