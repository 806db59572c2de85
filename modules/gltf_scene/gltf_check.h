#pragma once

#include "modules/gltf_scene/gltf_json.h"

namespace gnomon {

/// Checks a document before tinygltf parses it, because tinygltf silently accepts most errors.
/// Throws an Error unless every value that is read has a valid type and range and every index
/// refers to an existing element. An invalid value of a light, camera, material, texture, animation
/// channel or morph weight is only reported and replaced in r_json by its default. Logs a warning
/// for features that are not supported. Extras are not changed, because their meaning depends on
/// the reader.
void check_gltf(Json &r_json, GltfMessages &r_messages);

} // namespace gnomon
