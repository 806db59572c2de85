#pragma once

#include "modules/scene/scene_snapshot.h"

#include <cstdint>

namespace gnomon {

/// Counts over all casters of a light's shadow.
struct CasterCounts {
	uint64_t triangle_count = 0;
	uint64_t edge_count = 0;
};

/// Counts the casters. p_light: only those on the light's layers, cut-outs with the level of detail
/// for this light; null: all casters, cut-outs with the scene's usual level.
CasterCounts count_casters(const SceneSnapshot &p_scene, const LightSnapshot *p_light);

} // namespace gnomon
