#pragma once

#include "modules/gltf_scene/gltf_json.h"

namespace gnomon {

/// Checks a document before tinygltf gets it, which would take most of what is wrong without a
/// word. Afterwards every value that is read has its type and range, and every index has its
/// element: else fails. A refused value of a light, camera, material or texture is reported
/// instead, and its default used. Warns of what is not read. Extras, whose meaning
/// depends on who reads them, stay as they are.
void check_gltf(Json &r_json, GltfMessages &r_messages);

} // namespace gnomon
