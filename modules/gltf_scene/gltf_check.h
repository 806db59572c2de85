#pragma once

#include "modules/gltf_scene/gltf_json.h"

namespace gnomon {

/// Checks the parts of a document that tinygltf parses, because tinygltf silently accepts most
/// errors; lights, cameras, materials and textures are checked when they are read. Throws an Error
/// unless every value that is read has a valid type and range and every index refers to an existing
/// element. An invalid animation channel or morph weight is only reported and replaced in r_json by
/// its default. Logs a warning for features that are not supported.
void check_gltf(Json &r_json, GltfMessages &r_messages);

} // namespace gnomon
