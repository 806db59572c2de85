#ifndef TOPOLOGY_SHARED_H
#define TOPOLOGY_SHARED_H
#include "shared/shared_begin.h"

#define TOPOLOGY_NO_VERTEX 0xffffffffu
// In TopologyEdge::opposite1: both faces run a -> b.
#define TOPOLOGY_EDGE_INCONSISTENT 0x80000000u
// In the same: the edge's part is not closed, or inside out. A boundary's never is closed.
#define TOPOLOGY_EDGE_NOT_SOLID 0x40000000u
// Word per face: bit i, the face owns its edge i (corners i and i + 1); bit 3 + i, no other face shares
// it; bit 6 + i, the face that shares it runs along it in the same direction; bit 9, the face's part
// is not closed, or inside out.
#define TOPOLOGY_FACE_OWNS_EDGE 1u
#define TOPOLOGY_FACE_HAS_BOUNDARY 8u
#define TOPOLOGY_FACE_HAS_INCONSISTENT 64u
#define TOPOLOGY_FACE_NOT_SOLID 512u

/// One edge between welded vertices: a -> b as its first face winds.
struct SHARED_ALIGN TopologyEdge {
	uint a;
	uint b;
	uint opposite0; // third vertex of the first face
	uint opposite1; // of the second face, with _INCONSISTENT, _NOT_SOLID; or TOPOLOGY_NO_VERTEX: a boundary
};
SHARED_SIZE(TopologyEdge, 16);

#include "shared/shared_end.h"
#endif
