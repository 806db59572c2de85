#pragma once

#include "modules/gltf_scene/gltf_json.h"

namespace gnomon {

const uint64_t GLTF_MAX_JOINT_COUNT = 65536;			   // of one skin
const uint64_t GLTF_MAX_CHANNEL_COUNT = uint64_t(1) << 20; // of all animations together

/// Checks the skins of a document, as check_gltf does for the other elements.
void check_skins(const GltfObject &p_root);
/// Checks the animations of a document. An animation channel that cannot be read is reported and
/// gets the path "", which the reader skips.
void check_animations(const GltfObject &p_root);
/// Checks the morph weights of a node or a mesh: if they are not a list of finite numbers, the
/// whole list is reported and removed.
void check_morph_weights(const GltfObject &p_object);

} // namespace gnomon
