#pragma once

#include "modules/mesh_tools/topology.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace gnomon {

/// An edge between a light-facing and a back-facing face. In a part that is not closed it can also
/// be a boundary edge, or an edge whose two faces have opposite winding.
struct SilhouetteEdge {
	uint32_t edge_index = 0; // into MeshTopology::edges
	/// Welded vertices, in the direction in which the light-facing face runs along the edge.
	uint32_t from = 0;
	uint32_t to = 0;
	/// Multiplicity of the edge in a shadow volume: 1, or 2 for an interior edge of a double-sided
	/// part.
	uint32_t weight = 0;
};

/// The silhouette of a mesh as seen from one light, see build_silhouette.
struct Silhouette {
	std::vector<uint8_t> is_facing;	   // one per face: 1 when the light is strictly in front of it
	std::vector<SilhouetteEdge> edges; // in the order of MeshTopology::edges
};

/// Returns for each face 1 if the light is strictly in front of it, otherwise 0.
/// p_light_position_node: homogeneous position in node space; w = 0 is a light at infinity in the
/// direction xyz. A light in the face's plane, and any face without area, gives 0.
std::vector<uint8_t> compute_light_facing(
		const MeshTopology &p_topology, const glm::dvec4 &p_light_position_node);

/// Returns the sum over the edge's faces of (+1 if the face winds a -> b, else -1) x (+1 if it
/// faces the light, else -1): 0, +-1 or +-2. For closed parts, build_silhouette halves it. The sign
/// gives the direction of the silhouette edge: a -> b if positive, b -> a if negative.
int compute_edge_weight(const MeshEdge &p_edge, const std::vector<uint8_t> &p_is_facing);

/// Returns all edges with a nonzero weight. The incoming and outgoing weights of every vertex are
/// equal, so the edges form closed loops. Parts that are not closed are double-sided: each of their
/// faces counts as light-facing. The directions apply to node space; a mirroring transform swaps
/// from and to in the world. For a light that is not finite there are no edges and no face is
/// light-facing.
Silhouette build_silhouette(
		const MeshTopology &p_topology, const glm::dvec4 &p_light_position_node);

} // namespace gnomon
