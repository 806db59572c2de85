#pragma once

#include "modules/mesh_tools/topology.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace gnomon {

/// The same edges as the shaders find, bit for bit: silhouette_inc.glsl in C++, float32 in the same
/// order. Indices into MeshTopology::edges, ascending. Boundary edges always; edges of which one
/// face is light-facing and one is not. In general position these are the edges of
/// build_silhouette; where the light is in a face's plane up to rounding, they may differ.
std::vector<uint32_t> find_silhouette_edges(
		const MeshTopology &p_topology, const glm::vec4 &p_light_node);

} // namespace gnomon
