#ifndef TOPOLOGY_SHARED_H
#define TOPOLOGY_SHARED_H
#include "shared/shared_begin.h"

#define TOPOLOGY_NO_VERTEX 0xffffffffu
// In TopologyEdge::opposite1: both faces run a -> b.
#define TOPOLOGY_EDGE_INCONSISTENT 0x80000000u
// Word per face: bit i, the face owns its edge i (corners i and i + 1); bit 3 + i, nobody shares
// it; bit 6 + i, the face that shares it runs along it in the same direction.
#define TOPOLOGY_FACE_OWNS_EDGE 1u
#define TOPOLOGY_FACE_HAS_BOUNDARY 8u
#define TOPOLOGY_FACE_HAS_INCONSISTENT 64u

/// One edge between welded vertices: a -> b as its first face winds.
struct SHARED_ALIGN TopologyEdge {
	uint a;
	uint b;
	uint opposite0; // third vertex of the first face
	uint opposite1; // of the second face, with _INCONSISTENT; or TOPOLOGY_NO_VERTEX: a boundary
};
SHARED_SIZE(TopologyEdge, 16);

#include "shared/shared_end.h"
#endif
