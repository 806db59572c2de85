#pragma once

#include "modules/gltf_scene/gltf_json.h"
#include "modules/gltf_scene/gltf_textures.h"
#include "modules/scene/material.h"

#include <tiny_gltf.h>

namespace gnomon {

/// Reads a material. Invalid values of its extras are reported and replaced by their defaults. If a
/// material with scatter has no scatter_distance, the attenuation distance of KHR_materials_volume
/// is used: both are mean distances that light travels in the medium.
Material read_material(const tinygltf::Model &p_model, size_t p_index, GltfTextures &r_textures,
		GltfMessages &r_messages);

/// Writes what differs from p_before (all that is not a default, when null) into a material's
/// definition. r_model: the document, which names the extensions it uses.
void write_material(const Material &p_material, const Material *p_before, tinygltf::Model &r_model,
		tinygltf::Material &r_written);

} // namespace gnomon
