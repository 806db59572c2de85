#pragma once

#include "modules/gltf_scene/gltf_json.h"
#include "modules/gltf_scene/gltf_textures.h"
#include "modules/scene/material.h"

namespace gnomon {

/// A material of a file, without its images.
struct GltfMaterial {
	Material material;
	GltfTextureInfo base_color, metallic_roughness, normal, occlusion, emissive;
};

/// Reads and checks a material. An invalid value is reported, and its default used. If a material
/// with scatter has no scatter_distance, the attenuation distance of KHR_materials_volume is used:
/// both describe how far light travels in the medium. p_texture_count: length of the document's
/// list of textures.
GltfMaterial read_material(const GltfObject &p_json, size_t p_index, size_t p_texture_count);
/// Returns the material with its textures. Logs a warning if it is drawn otherwise than its author
/// may expect.
Material load_material_textures(
		const GltfMaterial &p_source, GltfTextures &r_textures, GltfMessages &r_messages);

/// Writes the values that differ from p_before, the material as loaded, or from the defaults if it
/// is null, into a material's definition. Textures are not written: r_target keeps its own. Adds
/// the extensions used to `extensionsUsed` of r_root, the document.
void write_material(
		const Material &p_material, const Material *p_before, Json &r_root, Json &r_target);

} // namespace gnomon
