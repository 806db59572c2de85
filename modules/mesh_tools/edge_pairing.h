#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace gnomon {

/// A face at an edge that more than two faces share.
struct FaceAtEdge {
	glm::dvec3 toward_face = glm::dvec3(0.0); // from a point of the edge to the face's third vertex
	bool runs_along = false;				  // the face's winding runs in the edge's direction
};

/// Indices into the faces given; second is NO_FACE for a face that stays alone.
struct FacePair {
	uint32_t first = 0;
	uint32_t second = 0;
};

/// Each face is in exactly one pair. Faces of opposite winding are paired so that each pair
/// encloses a wedge of the inside (two cubes that touch along an edge come apart into two cubes),
/// nested wedges like brackets; those left all have one winding and are paired in the order of
/// their angle.
std::vector<FacePair> pair_faces_at_edge(
		const glm::dvec3 &p_edge_direction, std::span<const FaceAtEdge> p_faces);

} // namespace gnomon
