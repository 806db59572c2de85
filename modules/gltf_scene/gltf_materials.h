#pragma once

#include "modules/gltf_scene/gltf_json.h"
#include "modules/gltf_scene/gltf_textures.h"
#include "modules/scene/material.h"

#include <tiny_gltf.h>

namespace gnomon {

/// Reads a material. Invalid values of its extras are reported and replaced by their defaults. If a
/// material with scatter has no scatter_distance, the attenuation distance of KHR_materials_volume
/// is used: both describe how far light travels in the medium.
Material read_material(const tinygltf::Model &p_model, size_t p_index, GltfTextures &r_textures,
		GltfMessages &r_messages);

/// Writes the values that differ from p_before, the material as loaded, or from the defaults if it
/// is null, into a material's definition. Textures are not written: r_target keeps its own. Adds
/// the extensions used to r_model's `extensionsUsed`.
void write_material(const Material &p_material, const Material *p_before, tinygltf::Model &r_model,
		tinygltf::Material &r_target);

} // namespace gnomon
