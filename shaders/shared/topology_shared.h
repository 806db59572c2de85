#ifndef TOPOLOGY_SHARED_H
#define TOPOLOGY_SHARED_H
#include "shared/shared_begin.h"

#define TOPOLOGY_NO_VERTEX 0xffffffffu
// Flag in TopologyEdge::opposite1: both faces wind a -> b. Boundaries must be tested first: as
// TOPOLOGY_NO_VERTEX has all bits set, they have this flag, too.
#define TOPOLOGY_EDGE_INCONSISTENT 0x80000000u
// Flag in TopologyEdge::opposite1: the edge's connected part of the mesh is not closed, or is
// inside out. Boundaries have it, too, which is correct: their part is not closed.
#define TOPOLOGY_EDGE_NOT_SOLID 0x40000000u
// Flags of a face. Edge i connects its corners i and i + 1. Bit i: the face owns edge i: it is the
// edge's first face. The next two are set at the owner only. Bit 3 + i: edge i has no second face.
// Bit 6 + i: the second face of edge i winds along it in the same direction. Bit 9: the face's
// connected part of the mesh is not closed, or is inside out.
#define TOPOLOGY_FACE_OWNS_EDGE 1u
#define TOPOLOGY_FACE_HAS_BOUNDARY 8u
#define TOPOLOGY_FACE_HAS_INCONSISTENT 64u
#define TOPOLOGY_FACE_NOT_SOLID 512u

/// One edge between welded vertices. Its first face winds a -> b.
struct SHARED_ALIGN TopologyEdge {
	uint a;
	uint b;
	uint opposite0; // third vertex of the first face
	uint opposite1; // third vertex of the second face, with TOPOLOGY_EDGE_* flags;
					// TOPOLOGY_NO_VERTEX: boundary
};
SHARED_SIZE(TopologyEdge, 16);

#include "shared/shared_end.h"
#endif
