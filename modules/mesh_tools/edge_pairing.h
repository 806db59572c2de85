#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace gnomon {

/// A face at an edge that more than two faces share.
struct EdgeFace {
	glm::dvec3 toward_face = glm::dvec3(0.0); // from a point of the edge to the face's third vertex
	bool runs_along = false;				  // the face's winding follows the edge's direction
};

/// Indices into the faces at an edge; second is NO_FACE (topology.h) for an unpaired face.
struct FacePair {
	uint32_t first = 0;
	uint32_t second = 0;
};

/// Pairs the faces at an edge, so that each face is in exactly one pair. Faces of opposite winding
/// are paired first, so that each pair encloses a wedge of the inside (two cubes that touch along
/// an edge become two separate cubes). Nested wedges are matched like brackets. The remaining faces
/// all have the same winding and are paired in the order of their angle about the edge.
std::vector<FacePair> pair_faces_at_edge(
		const glm::dvec3 &p_edge_direction, std::span<const EdgeFace> p_faces);

} // namespace gnomon
