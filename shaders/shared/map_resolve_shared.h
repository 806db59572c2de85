#ifndef MAP_RESOLVE_SHARED_H
#define MAP_RESOLVE_SHARED_H
#include "shared/shared_begin.h"

// What every resolve of light-view maps reads, see common/map_resolve_inc.glsl. A technique's own
// bindings begin after these.
#define MAP_RESOLVE_BINDING_FRAME 0
#define MAP_RESOLVE_BINDING_VIEWS 1
#define MAP_RESOLVE_BINDING_DEPTH 2
#define MAP_RESOLVE_BINDING_NORMAL 3
#define MAP_RESOLVE_BINDING_RECEIVERS 4
#define MAP_RESOLVE_OWN_BINDING 5

// What a technique with a depth map for each light view has there; see DepthMapTechnique.
#define DEPTH_MAP_BINDING_MAP (MAP_RESOLVE_OWN_BINDING + 0)
#define DEPTH_MAP_BINDING_MASK (MAP_RESOLVE_OWN_BINDING + 1)
#define DEPTH_MAP_OWN_BINDING (MAP_RESOLVE_OWN_BINDING + 2)

#define MAP_RESOLVE_GROUP_SIZE 8 // work groups of 8 x 8 pixels

#include "shared/shared_end.h"
#endif
