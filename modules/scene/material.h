#pragma once

#include "modules/scene/texture.h"

#include <glm/glm.hpp>

#include <array>
#include <string>

namespace gnomon {

/// How opaque surfaces reflect. METALLIC_ROUGHNESS: as glTF defines it (Lambert and GGX). PHONG:
/// Phong 1975, whose lobe is as wide as the roughness states; for images like those of older
/// papers.
enum class ShadingModel { METALLIC_ROUGHNESS, PHONG };

/// MASK: a surface is there where its alpha is at least the cutoff, and nowhere else. BLEND is
/// drawn and casts like MASK.
enum class AlphaMode { OPAQUE, MASK, BLEND };

/// What a surface looks like. Colours are linear. Immutable once shared. A texture multiplies the
/// values above it; a mesh's vertex colours multiply base colour and alpha.
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
	float scatter_distance_m = 0.0f; // 0..1e4; how far it spreads at s = 1; 0: not given
	/// KHR_materials_transmission: the share of the light that goes through, 0..1; it gets the
	/// base colour.
	float transmission = 0.0f;
	/// KHR_materials_volume: how much there is to go through, and what that leaves of the light:
	/// attenuation_color after attenuation_distance_m (0: infinite, nothing is lost).
	float thickness_m = 0.0f; // in the mesh's space
	glm::vec3 attenuation_color = glm::vec3(1.0f);
	float attenuation_distance_m = 0.0f;
	bool is_double_sided = false;
	AlphaMode alpha_mode = AlphaMode::OPAQUE;
	float alpha_cutoff = 0.5f;			// 0..1
	Texture base_color_texture;			// sRGB; its alpha is that of the surface
	Texture metallic_roughness_texture; // green: roughness, blue: metallic
	/// A unit vector in tangent space, 0..1 for -1..1; x and y times the scale.
	Texture normal_texture;
	float normal_scale = 1.0f;
	/// Red: how much of the ambient light arrives; 1 + strength (red - 1).
	Texture occlusion_texture;
	float occlusion_strength = 1.0f; // 0..1
	Texture emissive_texture;		 // sRGB
	/// Index in the file it came from, or -1. A changed copy keeps it, so that saving keeps what
	/// the program does not understand.
	int file_index = -1;

	bool operator==(const Material &) const = default;
	/// What a caster leaves of the light that meets it once, 0..1 for each colour; 0 = opaque.
	/// p_scale: of its node, for the thickness. Beer and Lambert's law (KHR_materials_volume).
	glm::vec3 compute_transmittance(float p_scale) const;
	/// Whether parts of its surfaces are not there. What lets light through is whole.
	bool is_cut_out() const { return alpha_mode != AlphaMode::OPAQUE && !(transmission > 0.0f); }
	std::array<const Texture *, 5> list_textures() const {
		return { &base_color_texture, &metallic_roughness_texture, &normal_texture,
			&occlusion_texture, &emissive_texture };
	}
};

/// "metallic_roughness", "phong".
const char *get_shading_model_name(ShadingModel p_model);

} // namespace gnomon
