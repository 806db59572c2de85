#pragma once

#include "modules/scene/scene_snapshot.h"

#include <cstdint>

namespace gnomon {

/// Number of triangles and edges of all shadow casters of a light.
struct CasterCounts {
	uint64_t triangle_count = 0;
	uint64_t edge_count = 0;
};

/// Counts the triangles and edges of the shadow casters. p_light: counts only casters on the
/// light's layers, with the level of detail of cut-out (alpha-masked) meshes for this light. Null:
/// counts all casters, with the scene's default level of detail.
CasterCounts count_casters(const SceneSnapshot &p_scene, const LightSnapshot *p_light);

} // namespace gnomon
