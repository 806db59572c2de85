#include "modules/gltf_scene/gltf_materials.h"

#include "modules/core/error.h"
#include "modules/core/limits.h"
#include "modules/gltf_scene/gltf_document.h"
#include "modules/gltf_scene/gltf_edit.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace gnomon {

namespace {

const double MAX_EMISSIVE_CD_M2 = 1e9; // about the luminance of the sun's disc

float read_float(const GltfObject &p_object, std::string_view p_key, double p_default,
		double p_minimum, double p_maximum, std::string_view p_unit = "") {
	return static_cast<float>(p_object.read_number(p_key, p_default, p_minimum, p_maximum, p_unit));
}

/// Reads a colour of 3 or 4 numbers in 0..1; returns p_default if it is absent or reported.
glm::vec3 read_color(const GltfObject &p_object, std::string_view p_key, float p_default) {
	glm::vec3 color(p_default);
	p_object.read_color(p_key, 1.0, std::span<float, 3>(&color.x, 3));
	return color;
}

void read_base_color(const GltfObject &p_surface, Material &r_material) {
	float color[3];
	if (!p_surface.read_color("baseColorFactor", 1.0, color)) {
		return;
	}
	r_material.base_color = glm::vec3(color[0], color[1], color[2]);
	const Json &factor = *p_surface.find("baseColorFactor");
	const double alpha = factor.size() == 3 ? 1.0
			: factor[3].is_number()			? factor[3].get<double>()
											: NAN;
	if (alpha >= 0 && alpha <= 1) {
		r_material.alpha = static_cast<float>(alpha);
	} else {
		p_surface.report_value("baseColorFactor", "four numbers in 0..1", "1 as alpha");
	}
}

void read_surface(const GltfObject &p_json, size_t p_texture_count, GltfMaterial &r_result) {
	Material &material = r_result.material;
	const auto read_texture = [&](const GltfObject &p_object, const char *p_key) {
		return read_texture_info(p_object, p_key, p_texture_count);
	};
	// glTF's defaults, which differ from those of Material.
	material.base_color = glm::vec3(1.0f);
	material.metallic = 1.0f;
	if (const auto surface = p_json.find_object("pbrMetallicRoughness")) {
		read_base_color(*surface, material);
		r_result.base_color = read_texture(*surface, "baseColorTexture");
		r_result.metallic_roughness = read_texture(*surface, "metallicRoughnessTexture");
		material.metallic = read_float(*surface, "metallicFactor", 1, 0, 1);
		material.roughness = read_float(*surface, "roughnessFactor", 1, 0, 1);
	}
	r_result.normal = read_texture(p_json, "normalTexture");
	material.normal_scale = r_result.normal.scale;
	r_result.occlusion = read_texture(p_json, "occlusionTexture");
	material.occlusion_strength = r_result.occlusion.strength;
	r_result.emissive = read_texture(p_json, "emissiveTexture");
	material.emissive = read_color(p_json, "emissiveFactor", 0.0f);
	if (const auto strength = p_json.find_extension(GLTF_EMISSIVE_STRENGTH)) {
		material.emissive *= read_float(*strength, "emissiveStrength", 1, 0, MAX_EMISSIVE_CD_M2);
	}
	material.is_double_sided = p_json.read_bool("doubleSided", false);
	const std::string mode = p_json.get_text("alphaMode");
	if (mode == "MASK" || mode == "BLEND") {
		material.alpha_mode = mode == "MASK" ? AlphaMode::MASK : AlphaMode::BLEND;
	} else if (p_json.find("alphaMode") && mode != "OPAQUE") {
		p_json.report_value("alphaMode", "\"OPAQUE\", \"MASK\" or \"BLEND\"", "\"OPAQUE\"");
	}
	// Blended surfaces are drawn and cast a shadow where alpha is at least 0.5.
	const float cutoff = read_float(p_json, "alphaCutoff", 0.5, 0, FLT_MAX);
	material.alpha_cutoff = material.alpha_mode == AlphaMode::MASK ? cutoff : 0.5f;
}

void read_transmission(const GltfObject &p_json, Material &r_material) {
	if (const auto transmission = p_json.find_extension(GLTF_TRANSMISSION)) {
		r_material.transmission = read_float(*transmission, "transmissionFactor", 0, 0, 1);
	}
	if (const auto volume = p_json.find_extension(GLTF_VOLUME)) {
		r_material.thickness_m = read_float(*volume, "thicknessFactor", 0, 0, MAX_LENGTH_M, "m");
		r_material.attenuation_color = read_color(*volume, "attenuationColor", 1.0f);
		r_material.attenuation_distance_m =
				read_float(*volume, "attenuationDistance", 0, 0, MAX_LENGTH_M, "m");
	}
}

/// Returns the scatter distance, in metres, that is used if the extras do not state one.
float derive_scatter_distance(const Material &p_material) {
	return p_material.scatter > 0 ? p_material.attenuation_distance_m : 0.0f;
}

void read_extras(const GltfObject &p_extras, Material &r_material) {
	r_material.scatter = read_float(p_extras, "scatter", 0, 0, 1);
	r_material.scatter_distance_m = read_float(p_extras, "scatter_distance",
			derive_scatter_distance(r_material), 0, MAX_LENGTH_M, "m");
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

const char *get_alpha_mode_name(AlphaMode p_mode) {
	return p_mode == AlphaMode::MASK ? "MASK" : p_mode == AlphaMode::BLEND ? "BLEND" : "OPAQUE";
}

/// Writes what differs from p_before. A new material always states its base colour, metallic and
/// roughness, because glTF's defaults (white and metallic) differ from those of Material.
void write_surface(const Material &p_material, const Material &p_before, bool p_is_new,
		Json &r_root, Json &r_target) {
	const auto surface = [&]() -> Json & {
		return require_object(r_target, "pbrMetallicRoughness");
	};
	if (p_is_new || p_material.base_color != p_before.base_color ||
			p_material.alpha != p_before.alpha) {
		const glm::vec3 &color = p_material.base_color;
		write_floats(surface(), "baseColorFactor", { color.x, color.y, color.z, p_material.alpha });
	}
	if (p_material.alpha_mode != p_before.alpha_mode) {
		r_target["alphaMode"] = get_alpha_mode_name(p_material.alpha_mode);
	}
	if (p_material.alpha_mode == AlphaMode::MASK &&
			p_material.alpha_cutoff != p_before.alpha_cutoff) {
		write_float(r_target, "alphaCutoff", p_material.alpha_cutoff);
	}
	if (p_is_new || p_material.metallic != p_before.metallic) {
		write_float(surface(), "metallicFactor", p_material.metallic);
	}
	if (p_is_new || p_material.roughness != p_before.roughness) {
		write_float(surface(), "roughnessFactor", p_material.roughness);
	}
	if (p_material.emissive != p_before.emissive) {
		const glm::vec3 &emissive = p_material.emissive;
		const float strength = std::max({ 1.0f, emissive.x, emissive.y, emissive.z });
		write_color(r_target, "emissiveFactor", emissive / strength);
		if (strength > 1.0f) { // emissiveFactor is limited to 1
			write_float(require_extension(r_root, r_target, GLTF_EMISSIVE_STRENGTH),
					"emissiveStrength", strength);
		} else {
			erase_member(r_target, "extensions", GLTF_EMISSIVE_STRENGTH);
		}
	}
	if (p_material.is_double_sided != p_before.is_double_sided) {
		r_target["doubleSided"] = p_material.is_double_sided;
	}
}

void write_transmission(
		const Material &p_material, const Material &p_before, Json &r_root, Json &r_target) {
	if (p_material.transmission != p_before.transmission) {
		write_float(require_extension(r_root, r_target, GLTF_TRANSMISSION), "transmissionFactor",
				p_material.transmission);
	}
	const auto volume = [&]() -> Json & {
		return require_extension(r_root, r_target, GLTF_VOLUME);
	};
	if (p_material.thickness_m != p_before.thickness_m) {
		write_float(volume(), "thicknessFactor", p_material.thickness_m);
	}
	if (p_material.attenuation_color != p_before.attenuation_color) {
		write_color(volume(), "attenuationColor", p_material.attenuation_color);
	}
	if (p_material.attenuation_distance_m != p_before.attenuation_distance_m) {
		if (p_material.attenuation_distance_m > 0) {
			write_float(volume(), "attenuationDistance", p_material.attenuation_distance_m);
		} else {
			volume().erase("attenuationDistance"); // absent: infinite
		}
	}
}

} // namespace

GltfMaterial read_material(const GltfObject &p_json, size_t p_index, size_t p_texture_count) {
	GltfMaterial result;
	result.material.name = p_json.get_text("name");
	result.material.file_index = static_cast<int>(p_index);
	read_surface(p_json, p_texture_count, result);
	read_transmission(p_json, result.material);
	if (const auto extras = p_json.find_extras()) {
		read_extras(*extras, result.material);
	}
	return result;
}

Material load_material_textures(
		const GltfMaterial &p_source, GltfTextures &r_textures, GltfMessages &r_messages) {
	Material material = p_source.material;
	material.base_color_texture = r_textures.load(p_source.base_color);
	material.metallic_roughness_texture = r_textures.load(p_source.metallic_roughness);
	material.normal_texture = r_textures.load(p_source.normal);
	material.occlusion_texture = r_textures.load(p_source.occlusion);
	material.emissive_texture = r_textures.load(p_source.emissive);
	const std::string path = text("materials[", material.file_index, "]");
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
	return material;
}

void write_material(
		const Material &p_material, const Material *p_before, Json &r_root, Json &r_target) {
	const Material defaults;
	const Material &before = p_before ? *p_before : defaults;
	if (!p_before && !p_material.name.empty()) {
		r_target["name"] = p_material.name;
	}
	write_surface(p_material, before, /*p_is_new=*/p_before == nullptr, r_root, r_target);
	write_transmission(p_material, before, r_root, r_target);
	if (p_material.scatter != before.scatter) {
		write_float(require_extras(r_target), "scatter", p_material.scatter);
	}
	// Without scatter_distance in the file, loading derives it from the attenuation distance, which
	// may have changed. It is written if the derived value would differ.
	const auto extras = r_target.find("extras");
	const bool has_distance = extras != r_target.end() && extras->contains("scatter_distance");
	if (has_distance ? p_material.scatter_distance_m != before.scatter_distance_m
					 : p_material.scatter_distance_m != derive_scatter_distance(p_material)) {
		write_float(require_extras(r_target), "scatter_distance", p_material.scatter_distance_m);
	}
	if (p_material.shading_model != before.shading_model) {
		require_extras(r_target)["shading_model"] =
				get_shading_model_name(p_material.shading_model);
	}
}

} // namespace gnomon
