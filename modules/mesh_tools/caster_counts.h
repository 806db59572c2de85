#pragma once

#include "modules/scene/scene_snapshot.h"

#include <cstdint>

namespace gnomon {

/// Counts over all casters of a light's shadow.
struct CasterCounts {
	uint64_t triangle_count = 0;
	uint64_t edge_count = 0;
};

/// p_light: cut-out casters use the level of detail for this light; null: they use the base level.
CasterCounts count_casters(const SceneSnapshot &p_scene, const LightSnapshot *p_light);

} // namespace gnomon
