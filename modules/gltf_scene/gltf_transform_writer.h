#pragma once

#include "modules/gltf_scene/gltf_json.h"
#include "modules/scene/nodes.h"

namespace gnomon {

/// Writes a node's changed transform. Translation, rotation and scale are kept apart where they can
/// say it (animations and people need them), else it becomes a matrix. Not finite: an Error.
void write_transform(const Node3D &p_node, const glm::dmat4 &p_before, Json &r_json);

} // namespace gnomon
