#pragma once

#include "modules/gltf_scene/gltf_json.h"

namespace gnomon {

/// Checks a document before tinygltf parses it, because tinygltf silently accepts most errors.
/// Afterwards every value that is read has its type and range, and every index refers to an
/// existing element; otherwise the check fails. An invalid value of a light, camera, material or
/// texture is only reported, and its default used. Warns of features that are not read. Extras are
/// not changed, because their meaning depends on the reader.
void check_gltf(Json &r_json, GltfMessages &r_messages);

} // namespace gnomon
