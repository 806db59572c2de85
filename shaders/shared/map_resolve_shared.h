#ifndef MAP_RESOLVE_SHARED_H
#define MAP_RESOLVE_SHARED_H
#include "shared/shared_begin.h"

// Bindings of all shaders that look receivers up in maps of the light's views, see
// common/map_resolve_inc.glsl. A technique's own bindings start at MAP_RESOLVE_FIRST_FREE_BINDING.
#define MAP_RESOLVE_BINDING_FRAME 0
#define MAP_RESOLVE_BINDING_VIEWS 1
#define MAP_RESOLVE_BINDING_DEPTH 2
#define MAP_RESOLVE_BINDING_NORMAL 3
#define MAP_RESOLVE_BINDING_RECEIVERS 4
#define MAP_RESOLVE_BINDING_TILES 5 // LitTiles::tiles
#define MAP_RESOLVE_FIRST_FREE_BINDING 6

// The next bindings of techniques that derive from DepthMapTechnique. Their own start at
// DEPTH_MAP_FIRST_FREE_BINDING.
#define DEPTH_MAP_BINDING_MAP (MAP_RESOLVE_FIRST_FREE_BINDING + 0)
#define DEPTH_MAP_BINDING_MASK (MAP_RESOLVE_FIRST_FREE_BINDING + 1)
#define DEPTH_MAP_FIRST_FREE_BINDING (MAP_RESOLVE_FIRST_FREE_BINDING + 2)

#define MAP_RESOLVE_GROUP_SIZE 8 // work groups of 8 x 8 pixels

#include "shared/shared_end.h"
#endif
