#include "modules/gltf_scene/gltf_materials.h"

#include "modules/core/error.h"
#include "modules/core/limits.h"
#include "modules/gltf_scene/gltf_document.h"
#include "modules/gltf_scene/gltf_values.h"

#include <algorithm>

namespace gnomon {

using tinygltf::Value;

namespace {

glm::vec3 to_color(const std::vector<double> &p_numbers) {
	return glm::vec3(p_numbers[0], p_numbers[1], p_numbers[2]);
}

std::vector<double> to_numbers(const glm::vec3 &p_color) {
	return { to_shortest_decimal(p_color.x), to_shortest_decimal(p_color.y),
		to_shortest_decimal(p_color.z) };
}

Value to_value(float p_number) {
	return Value(to_shortest_decimal(p_number));
}

Value to_value(const glm::vec3 &p_color) {
	return Value(Value::Array{ to_value(p_color.x), to_value(p_color.y), to_value(p_color.z) });
}

void read_surface(
		const tinygltf::Material &p_source, GltfTextures &r_textures, Material &r_material) {
	const tinygltf::PbrMetallicRoughness &surface = p_source.pbrMetallicRoughness;
	r_material.base_color = to_color(surface.baseColorFactor);
	r_material.alpha = static_cast<float>(surface.baseColorFactor[3]);
	r_material.base_color_texture = r_textures.read(surface.baseColorTexture);
	r_material.metallic = static_cast<float>(surface.metallicFactor);
	r_material.roughness = static_cast<float>(surface.roughnessFactor);
	r_material.metallic_roughness_texture = r_textures.read(surface.metallicRoughnessTexture);
	r_material.normal_texture = r_textures.read(p_source.normalTexture);
	r_material.normal_scale = static_cast<float>(p_source.normalTexture.scale);
	r_material.occlusion_texture = r_textures.read(p_source.occlusionTexture);
	r_material.occlusion_strength = static_cast<float>(p_source.occlusionTexture.strength);
	r_material.emissive = to_color(p_source.emissiveFactor);
	r_material.emissive_texture = r_textures.read(p_source.emissiveTexture);
	if (const Value *strength = find_extension(p_source.extensions, GLTF_EMISSIVE_STRENGTH)) {
		r_material.emissive *= static_cast<float>(get_number(*strength, "emissiveStrength", 1));
	}
	r_material.is_double_sided = p_source.doubleSided;
	r_material.alpha_mode = p_source.alphaMode == "MASK" ? AlphaMode::MASK
			: p_source.alphaMode == "BLEND"				 ? AlphaMode::BLEND
														 : AlphaMode::OPAQUE;
	// Blended surfaces are drawn and cast a shadow where alpha is at least 0.5.
	r_material.alpha_cutoff = r_material.alpha_mode == AlphaMode::MASK
			? static_cast<float>(p_source.alphaCutoff)
			: 0.5f;
}

void read_transmission(const tinygltf::Material &p_source, Material &r_material) {
	if (const Value *transmission = find_extension(p_source.extensions, GLTF_TRANSMISSION)) {
		r_material.transmission =
				static_cast<float>(get_number(*transmission, "transmissionFactor", 0));
	}
	if (const Value *volume = find_extension(p_source.extensions, GLTF_VOLUME)) {
		r_material.thickness_m = static_cast<float>(get_number(*volume, "thicknessFactor", 0));
		if (volume->Has("attenuationColor")) {
			for (int channel = 0; channel < 3; ++channel) {
				r_material.attenuation_color[channel] = static_cast<float>(
						volume->Get("attenuationColor").Get(channel).GetNumberAsDouble());
			}
		}
		r_material.attenuation_distance_m =
				static_cast<float>(get_number(*volume, "attenuationDistance", 0));
	}
}

/// Returns the scatter distance, in metres, that is used if the extras do not state one.
float derive_scatter_distance(const Material &p_material) {
	return p_material.scatter > 0 ? p_material.attenuation_distance_m : 0.0f;
}

void read_extras(const GltfObject &p_extras, Material &r_material) {
	r_material.scatter = static_cast<float>(
			p_extras.read_number("scatter", /*p_default=*/0, /*p_minimum=*/0, /*p_maximum=*/1));
	r_material.scatter_distance_m = static_cast<float>(p_extras.read_number(
			"scatter_distance", derive_scatter_distance(r_material), 0, MAX_LENGTH_M, "m"));
	if (p_extras.find("shading_model")) {
		const std::string name = p_extras.get_text("shading_model");
		if (name == get_shading_model_name(ShadingModel::PHONG)) {
			r_material.shading_model = ShadingModel::PHONG;
		} else if (name != get_shading_model_name(ShadingModel::METALLIC_ROUGHNESS)) {
			p_extras.report_value("shading_model", "metallic_roughness or phong",
					get_shading_model_name(ShadingModel::METALLIC_ROUGHNESS));
		}
	}
}

/// Writes a number if it differs from p_before, its value in the file or the default for a new
/// material.
void write_number(float p_value, float p_before, const char *p_key, Value::Object &r_object) {
	if (p_value != p_before) {
		r_object[p_key] = to_value(p_value);
	}
}

const char *get_alpha_mode_name(AlphaMode p_mode) {
	return p_mode == AlphaMode::MASK ? "MASK" : p_mode == AlphaMode::BLEND ? "BLEND" : "OPAQUE";
}

/// Writes what differs from p_before. A new material always states its base colour, metallic and
/// roughness, because glTF's defaults (white and metallic) differ from those of Material.
void write_surface(const Material &p_material, const Material &p_before, bool p_is_new,
		tinygltf::Model &r_model, tinygltf::Material &r_target) {
	tinygltf::PbrMetallicRoughness &surface = r_target.pbrMetallicRoughness;
	if (p_is_new || p_material.base_color != p_before.base_color) {
		const double alpha = surface.baseColorFactor[3];
		surface.baseColorFactor = to_numbers(p_material.base_color);
		surface.baseColorFactor.push_back(alpha);
	}
	if (p_material.alpha != p_before.alpha) {
		surface.baseColorFactor[3] = to_shortest_decimal(p_material.alpha);
	}
	if (p_material.alpha_mode != p_before.alpha_mode) {
		r_target.alphaMode = get_alpha_mode_name(p_material.alpha_mode);
	}
	if (p_material.alpha_mode == AlphaMode::MASK &&
			p_material.alpha_cutoff != p_before.alpha_cutoff) {
		r_target.alphaCutoff = to_shortest_decimal(p_material.alpha_cutoff);
	}
	if (p_is_new || p_material.metallic != p_before.metallic) {
		surface.metallicFactor = to_shortest_decimal(p_material.metallic);
	}
	if (p_is_new || p_material.roughness != p_before.roughness) {
		surface.roughnessFactor = to_shortest_decimal(p_material.roughness);
	}
	if (p_material.emissive != p_before.emissive) {
		const glm::vec3 &emissive = p_material.emissive;
		const float strength = std::max({ 1.0f, emissive.x, emissive.y, emissive.z });
		r_target.emissiveFactor = to_numbers(emissive / strength);
		r_target.extensions.erase(GLTF_EMISSIVE_STRENGTH);
		if (strength > 1.0f) { // emissiveFactor is limited to 1
			require_object(r_target.extensions[GLTF_EMISSIVE_STRENGTH])["emissiveStrength"] =
					to_value(strength);
			declare_extension(r_model, GLTF_EMISSIVE_STRENGTH);
		}
	}
	if (p_material.is_double_sided != p_before.is_double_sided) {
		r_target.doubleSided = p_material.is_double_sided;
	}
}

void write_transmission(const Material &p_material, const Material &p_before,
		tinygltf::Model &r_model, tinygltf::Material &r_target) {
	if (p_material.transmission != p_before.transmission) {
		require_object(r_target.extensions[GLTF_TRANSMISSION])["transmissionFactor"] =
				to_value(p_material.transmission);
		declare_extension(r_model, GLTF_TRANSMISSION);
	}
	if (p_material.thickness_m == p_before.thickness_m &&
			p_material.attenuation_color == p_before.attenuation_color &&
			p_material.attenuation_distance_m == p_before.attenuation_distance_m) {
		return;
	}
	Value::Object &volume = require_object(r_target.extensions[GLTF_VOLUME]);
	write_number(p_material.thickness_m, p_before.thickness_m, "thicknessFactor", volume);
	if (p_material.attenuation_color != p_before.attenuation_color) {
		volume["attenuationColor"] = to_value(p_material.attenuation_color);
	}
	if (p_material.attenuation_distance_m != p_before.attenuation_distance_m) {
		volume.erase("attenuationDistance"); // absent: infinite
		if (p_material.attenuation_distance_m > 0) {
			volume["attenuationDistance"] = to_value(p_material.attenuation_distance_m);
		}
	}
	declare_extension(r_model, GLTF_VOLUME);
}

} // namespace

Material read_material(const tinygltf::Model &p_model, size_t p_index, GltfTextures &r_textures,
		GltfMessages &r_messages) {
	const tinygltf::Material &source = p_model.materials[p_index];
	const std::string path = text("materials[", p_index, "]");
	Material material;
	material.name = source.name;
	material.file_index = static_cast<int>(p_index);
	read_surface(source, r_textures, material);
	read_transmission(source, material);
	if (material.alpha_mode == AlphaMode::BLEND && material.is_cut_out()) {
		r_messages.warn("blend", path,
				"has alphaMode BLEND: it is drawn and casts shadows like MASK, where alpha is at "
				"least 0.5. Use KHR_materials_transmission to let light through.");
	}
	if (material.is_cut_out() && material.alpha < material.alpha_cutoff) {
		r_messages.warn("invisible", path,
				text("has an alpha of ", to_shortest_decimal(material.alpha), ", less than ",
						to_shortest_decimal(material.alpha_cutoff),
						": nothing of it is drawn. Raise it in baseColorFactor, or make it glass "
						"with KHR_materials_transmission."));
	}
	if (const auto extras = find_object(source.extras, path + ".extras", r_messages)) {
		read_extras(*extras, material);
	}
	return material;
}

void write_material(const Material &p_material, const Material *p_before, tinygltf::Model &r_model,
		tinygltf::Material &r_target) {
	const Material defaults;
	const Material &before = p_before ? *p_before : defaults;
	if (!p_before && !p_material.name.empty()) {
		r_target.name = p_material.name;
	}
	write_surface(p_material, before, /*p_is_new=*/p_before == nullptr, r_model, r_target);
	write_transmission(p_material, before, r_model, r_target);
	// Without scatter_distance in the file, loading derives it from the attenuation distance, which
	// may have changed. It is written if the derived value would differ.
	const bool has_distance = r_target.extras.Has("scatter_distance");
	const bool must_write_distance = has_distance
			? p_material.scatter_distance_m != before.scatter_distance_m
			: p_material.scatter_distance_m != derive_scatter_distance(p_material);
	if (p_material.scatter != before.scatter || must_write_distance ||
			p_material.shading_model != before.shading_model) {
		Value::Object &extras = require_extras(r_target.extras);
		write_number(p_material.scatter, before.scatter, "scatter", extras);
		if (must_write_distance) {
			extras["scatter_distance"] = to_value(p_material.scatter_distance_m);
		}
		if (p_material.shading_model != before.shading_model) {
			extras["shading_model"] =
					Value(std::string(get_shading_model_name(p_material.shading_model)));
		}
	}
}

} // namespace gnomon
