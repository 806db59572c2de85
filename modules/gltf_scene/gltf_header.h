#pragma once

#include "modules/gltf_scene/gltf_json.h"

namespace gnomon {

/// Fails on another version than 2.x and on a required extension that is neither read nor harmless;
/// warns of what is not read.
void check_gltf_header(const GltfObject &p_root);

} // namespace gnomon
