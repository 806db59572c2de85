#pragma once

#include "modules/gltf_scene/gltf_json.h"

namespace gnomon {

const uint64_t GLTF_MAX_JOINT_COUNT = 65536;			   // of one skin
const uint64_t GLTF_MAX_CHANNEL_COUNT = uint64_t(1) << 20; // of all animations

/// The same as check_gltf, for a document's skins and animations. A channel of an animation that
/// cannot be read is reported; its path becomes "", which the reader skips.
void check_skins(const GltfObject &p_root);
void check_animations(const GltfObject &p_root);
/// Checks the morph weights of a node or a mesh: if they are not a list of finite numbers, the
/// whole list is reported and removed.
void check_morph_weights(const GltfObject &p_object);

} // namespace gnomon
