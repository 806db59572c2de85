#pragma once

#include "modules/scene/texture.h"

#include <glm/glm.hpp>

#include <array>
#include <string>

namespace gnomon {

/// How opaque surfaces reflect. METALLIC_ROUGHNESS: as glTF defines it (Lambert and GGX). PHONG:
/// Phong 1975, whose lobe is as wide as the roughness specifies; for images like those of older
/// papers.
enum class ShadingModel { METALLIC_ROUGHNESS, PHONG };

/// MASK: the surface exists only where its alpha is at least the cutoff. BLEND is drawn and casts
/// shadows like MASK, with a cutoff of 0.5.
enum class AlphaMode { OPAQUE, MASK, BLEND };

/// A surface's material. Colours are linear. Immutable once shared. Base colour, emissive
/// and metallic-roughness textures multiply the values of their name; a mesh's vertex colours
/// multiply base colour and alpha.
struct Material {
	std::string name;
	glm::vec3 base_color = glm::vec3(0.8f);
	float alpha = 1.0f;					  // 0..1
	glm::vec3 emissive = glm::vec3(0.0f); // cd/m^2
	float metallic = 0.0f;				  // 0..1
	float roughness = 1.0f;				  // 0..1
	ShadingModel shading_model = ShadingModel::METALLIC_ROUGHNESS;
	/// s in 0..1 (Wang, Xiao 2015): how much light spreads below the surface; 0 = opaque.
	float scatter = 0.0f;
	float scatter_distance_m = 0.0f; // 0..1e4; how far light spreads at s = 1; 0: not given
	/// KHR_materials_transmission: the fraction of light that passes through, 0..1; the base colour
	/// tints it.
	float transmission = 0.0f;
	/// KHR_materials_volume: the thickness of the volume, and the light that remains in it:
	/// attenuation_color after attenuation_distance_m (0: infinite, nothing is absorbed).
	float thickness_m = 0.0f; // in the mesh's space, before the node's scale
	glm::vec3 attenuation_color = glm::vec3(1.0f);
	float attenuation_distance_m = 0.0f;
	bool is_double_sided = false;
	AlphaMode alpha_mode = AlphaMode::OPAQUE;
	float alpha_cutoff = 0.5f;			// 0..1
	Texture base_color_texture;			// sRGB; its alpha is the surface's alpha
	Texture metallic_roughness_texture; // green: roughness, blue: metallic
	/// Tangent-space unit normals, stored as 0..1 for -1..1; x and y are multiplied by the scale.
	Texture normal_texture;
	float normal_scale = 1.0f;
	/// Red: the fraction of ambient light that arrives, applied as 1 + strength (red - 1).
	Texture occlusion_texture;
	float occlusion_strength = 1.0f; // 0..1
	Texture emissive_texture;		 // sRGB
	/// Index in the source file, or -1. A changed copy keeps it, so that saving preserves data that
	/// the program does not understand.
	int file_index = -1;

	bool operator==(const Material &) const = default;
	/// Computes the fraction of light that remains after it passes through the caster once, 0..1
	/// per colour channel; 0 = opaque. p_scale: scale of the node, which scales the thickness.
	/// Beer-Lambert law (KHR_materials_volume), without the texture of the base colour.
	glm::vec3 compute_transmittance(float p_scale) const;
	/// Whether an alpha test removes parts of the surface. Materials that transmit light are not
	/// cut out.
	bool is_cut_out() const { return alpha_mode != AlphaMode::OPAQUE && !(transmission > 0.0f); }
	std::array<const Texture *, 5> list_textures() const {
		return { &base_color_texture, &metallic_roughness_texture, &normal_texture,
			&occlusion_texture, &emissive_texture };
	}
};

/// Returns "metallic_roughness" or "phong".
const char *get_shading_model_name(ShadingModel p_model);

} // namespace gnomon
