#pragma once

#include "modules/scene/scene_snapshot.h"

#include <cstdint>

namespace gnomon {

/// Of all that casts a light's shadow.
struct CasterCounts {
	uint64_t triangle_count = 0;
	uint64_t edge_count = 0;
};

/// p_light: what is cut out has the outlines that it gets; null: the usual ones.
CasterCounts count_casters(const SceneSnapshot &p_scene, const LightSnapshot *p_light);

} // namespace gnomon
