#pragma once

#include "modules/gltf_scene/gltf_json.h"
#include "modules/scene/material.h"

namespace gnomon {

/// A material's values; bad ones are reported and replaced by their defaults. Where a material with
/// scatter has no scatter_distance, the attenuation distance of KHR_materials_volume takes its
/// place: both say how far light comes before it meets something.
Material read_material(const GltfObject &p_material, int p_index);

/// Writes what differs from p_before (all that is not a default, when null) into a material's
/// definition. r_root: the document, which names the extensions it uses.
void write_material(
		const Material &p_material, const Material *p_before, Json &r_root, Json &r_material);

} // namespace gnomon
