#pragma once

#include "modules/gltf_scene/gltf_accessors.h"
#include "modules/scene/animation.h"

#include <memory>
#include <vector>

namespace gnomon {

/// Reads all animations of a file. A channel that cannot be played (times that do not ascend,
/// values that are not finite, counts that do not match) is reported and skipped.
std::vector<std::shared_ptr<const Animation>> read_animations(
		const tinygltf::Model &p_model, GltfAccessors &p_accessors, GltfMessages &r_messages);

} // namespace gnomon
