#pragma once

#include "modules/mesh_tools/topology.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace gnomon {

/// An edge between a light-facing and a back-facing side of the surface. In a part that is not
/// closed this can be a boundary edge, or one whose two faces have opposite winding.
struct SilhouetteEdge {
	uint32_t edge_index = 0; // into MeshTopology::edges
	/// Welded vertices, in the direction in which the surface winds on its light-facing side.
	uint32_t from = 0;
	uint32_t to = 0;
	/// Multiplicity of the edge in a shadow volume: 1, or 2 for an interior edge of a double-sided
	/// part.
	uint32_t weight = 0;
};

struct Silhouette {
	std::vector<uint8_t> is_facing;	   // one per face: 1 when the light is strictly in front of it
	std::vector<SilhouetteEdge> edges; // in the order of MeshTopology::edges
};

/// Returns one entry per face. p_light_node: xyz/w is a point of node space; w = 0: the direction
/// xyz towards a light at infinity. A light in the face's plane, and any face without area, gives
/// 0.
std::vector<uint8_t> compute_facing(const MeshTopology &p_topology, const glm::dvec4 &p_light_node);

/// Sum over the edge's faces of (+1 if the face winds a -> b, else -1) x (+1 if it faces the light,
/// else -1): 0, +-1 or +-2; closed parts halve it. The sign is that of the direction in which
/// the silhouette runs: above 0 a -> b, below 0 b -> a.
int compute_edge_weight(const MeshEdge &p_edge, const std::vector<uint8_t> &p_is_facing);

/// Returns all edges with a nonzero weight. At every vertex the incoming and outgoing weights are
/// equal, so that they form closed loops. Parts that are not closed are double-sided: each of their
/// faces counts as light-facing. The directions apply to node space: a mirroring transform swaps
/// from and to in the world. A light that is not finite has no silhouette and faces nothing.
Silhouette build_silhouette(const MeshTopology &p_topology, const glm::dvec4 &p_light_node);

} // namespace gnomon
