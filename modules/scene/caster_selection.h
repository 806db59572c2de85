#pragma once

#include "modules/scene/scene_snapshot.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace gnomon {

/// The casters of one light, see SceneSnapshot::select_casters. From frame to frame it selects
/// again only those of the pages of instances that have changed.
class CasterSelection {
public:
	/// Returns what SceneSnapshot::select_casters returns. p_bounds: of all instances.
	std::shared_ptr<const SceneSnapshot> update(
			const SceneSnapshot &p_scene, const LightSnapshot &p_light, const Bounds &p_bounds);

private:
	SharedVector<InstanceSnapshot> source; // of the last update
	SharedVector<InstanceSnapshot> selected;
	std::vector<uint8_t> differs; // by page: whether selected has another page than source
	uint64_t light_hash = 0;
	Bounds bounds_world;
};

} // namespace gnomon
