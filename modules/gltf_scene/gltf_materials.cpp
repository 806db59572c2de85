#include "modules/gltf_scene/gltf_materials.h"

#include "modules/core/error.h"
#include "modules/core/limits.h"

#include <algorithm>

namespace gnomon {

namespace {

const double MAX_EMISSIVE_CD_M2 = 1e9; // the sun's disc
const char TRANSMISSION[] = "KHR_materials_transmission";
const char VOLUME[] = "KHR_materials_volume";
const char STRENGTH[] = "KHR_materials_emissive_strength";

std::span<float, 3> to_span(glm::vec3 &r_color) {
	return std::span<float, 3>(&r_color[0], 3);
}

void read_surface(const GltfObject &p_material, Material &r_material) {
	const Json *alpha_mode = p_material.find("alphaMode");
	if (alpha_mode != nullptr && *alpha_mode != "OPAQUE") {
		p_material.get_messages().warn("alpha", p_material.get_path(),
				"has an alphaMode, which is not read: it is opaque. Light goes through with "
				"KHR_materials_transmission.");
	}
	r_material.base_color = glm::vec3(1.0f);
	r_material.metallic = 1.0f;
	if (const auto surface = p_material.find_object("pbrMetallicRoughness")) {
		surface->read_color("baseColorFactor", 1.0, to_span(r_material.base_color));
		r_material.metallic = static_cast<float>(surface->read_number("metallicFactor", 1, 0, 1));
		r_material.roughness = static_cast<float>(surface->read_number("roughnessFactor", 1, 0, 1));
		if (surface->find("baseColorTexture")) {
			p_material.get_messages().warn(
					"texture", p_material.get_path(), "has a texture; textures are not read yet.");
		}
	}
	p_material.read_color("emissiveFactor", 1.0, to_span(r_material.emissive));
	if (const auto strength = p_material.find_extension(STRENGTH)) {
		r_material.emissive *= static_cast<float>(
				strength->read_number("emissiveStrength", 1, 0, MAX_EMISSIVE_CD_M2));
	}
	r_material.is_double_sided = p_material.read_bool("doubleSided", false);
}

void read_transmission(const GltfObject &p_material, Material &r_material) {
	if (const auto extension = p_material.find_extension(TRANSMISSION)) {
		r_material.transmission =
				static_cast<float>(extension->read_number("transmissionFactor", 0, 0, 1));
	}
	if (const auto volume = p_material.find_extension(VOLUME)) {
		r_material.thickness_m =
				static_cast<float>(volume->read_number("thicknessFactor", 0, 0, MAX_LENGTH_M, "m"));
		volume->read_color("attenuationColor", 1.0, to_span(r_material.attenuation_color));
		r_material.attenuation_distance_m = static_cast<float>(
				volume->read_number("attenuationDistance", 0, 0, MAX_LENGTH_M, "m"));
	}
}

/// In metres, where the extras do not tell it.
float derive_scatter_distance(const Material &p_material) {
	return p_material.scatter > 0 ? p_material.attenuation_distance_m : 0.0f;
}

void read_extras(const GltfObject &p_material, Material &r_material) {
	const std::optional<GltfObject> values = p_material.find_extras();
	if (!values) {
		return;
	}
	r_material.scatter = static_cast<float>(values->read_number("scatter", 0, 0, 1));
	r_material.scatter_distance_m = static_cast<float>(values->read_number(
			"scatter_distance", derive_scatter_distance(r_material), 0, MAX_LENGTH_M, "m"));
	if (values->find("shading_model")) {
		const std::string name = values->get_text("shading_model");
		if (name == get_shading_model_name(ShadingModel::PHONG)) {
			r_material.shading_model = ShadingModel::PHONG;
		} else if (name != get_shading_model_name(ShadingModel::METALLIC_ROUGHNESS)) {
			values->report_value("shading_model", "metallic_roughness or phong",
					get_shading_model_name(ShadingModel::METALLIC_ROUGHNESS));
		}
	}
}

/// Writes a number where it differs from what the file has. A default is not written anew.
void write_number(float p_value, float p_before, const char *p_key, Json &r_object) {
	if (p_value != p_before) {
		r_object[p_key] = to_json_number(p_value);
	}
}

void write_surface(const Material &p_material, const Material &p_before, bool p_is_new,
		Json &r_root, Json &r_material) {
	if (p_is_new || p_material.base_color != p_before.base_color ||
			p_material.metallic != p_before.metallic ||
			p_material.roughness != p_before.roughness) {
		Json &surface = require_object(r_material, "pbrMetallicRoughness");
		if (p_is_new || p_material.base_color != p_before.base_color) {
			Json color = to_json(p_material.base_color);
			const Json &old = surface.value("baseColorFactor", Json());
			color.push_back(old.is_array() && old.size() == 4 ? old[3] : Json(1.0));
			surface["baseColorFactor"] = std::move(color);
		}
		if (p_is_new || p_material.metallic != p_before.metallic) {
			surface["metallicFactor"] = to_json_number(p_material.metallic);
		}
		if (p_is_new || p_material.roughness != p_before.roughness) {
			surface["roughnessFactor"] = to_json_number(p_material.roughness);
		}
	}
	if (p_material.emissive != p_before.emissive) {
		const glm::vec3 &emissive = p_material.emissive;
		const float strength = std::max({ 1.0f, emissive.x, emissive.y, emissive.z });
		r_material["emissiveFactor"] = to_json(emissive / strength);
		Json &extensions = require_object(r_material, "extensions");
		extensions.erase(STRENGTH);
		if (strength > 1.0f) { // the factor alone ends at 1
			extensions[STRENGTH]["emissiveStrength"] = to_json_number(strength);
			declare_extension(r_root, STRENGTH);
		} else if (extensions.empty()) {
			r_material.erase("extensions");
		}
	}
	if (p_material.is_double_sided != p_before.is_double_sided) {
		r_material["doubleSided"] = p_material.is_double_sided;
	}
}

void write_transmission(
		const Material &p_material, const Material &p_before, Json &r_root, Json &r_material) {
	if (p_material.transmission != p_before.transmission) {
		require_object(require_object(r_material, "extensions"),
				TRANSMISSION)["transmissionFactor"] = to_json_number(p_material.transmission);
		declare_extension(r_root, TRANSMISSION);
	}
	if (p_material.thickness_m == p_before.thickness_m &&
			p_material.attenuation_color == p_before.attenuation_color &&
			p_material.attenuation_distance_m == p_before.attenuation_distance_m) {
		return;
	}
	Json &volume = require_object(require_object(r_material, "extensions"), VOLUME);
	write_number(p_material.thickness_m, p_before.thickness_m, "thicknessFactor", volume);
	if (p_material.attenuation_color != p_before.attenuation_color) {
		volume["attenuationColor"] = to_json(p_material.attenuation_color);
	}
	if (p_material.attenuation_distance_m != p_before.attenuation_distance_m) {
		volume.erase("attenuationDistance"); // absent: infinite
		if (p_material.attenuation_distance_m > 0) {
			volume["attenuationDistance"] = to_json_number(p_material.attenuation_distance_m);
		}
	}
	declare_extension(r_root, VOLUME);
}

} // namespace

Material read_material(const GltfObject &p_material, int p_index) {
	Material material;
	material.name = p_material.get_text("name");
	material.file_index = p_index;
	read_surface(p_material, material);
	read_transmission(p_material, material);
	read_extras(p_material, material);
	return material;
}

void write_material(
		const Material &p_material, const Material *p_before, Json &r_root, Json &r_material) {
	const Material fresh;
	const Material &before = p_before ? *p_before : fresh;
	if (!p_before && !p_material.name.empty()) {
		r_material["name"] = p_material.name;
	}
	write_surface(p_material, before, p_before == nullptr, r_root, r_material);
	write_transmission(p_material, before, r_root, r_material);
	// Absent, it would be derived: also from what has just changed.
	const bool tells_distance = r_material.value("extras", Json()).contains("scatter_distance");
	const bool must_tell_distance = tells_distance
			? p_material.scatter_distance_m != before.scatter_distance_m
			: p_material.scatter_distance_m != derive_scatter_distance(p_material);
	if (p_material.scatter != before.scatter || must_tell_distance ||
			p_material.shading_model != before.shading_model) {
		Json &extras = require_extras(r_material);
		write_number(p_material.scatter, before.scatter, "scatter", extras);
		if (must_tell_distance) {
			extras["scatter_distance"] = to_json_number(p_material.scatter_distance_m);
		}
		if (p_material.shading_model != before.shading_model) {
			extras["shading_model"] = get_shading_model_name(p_material.shading_model);
		}
	}
}

} // namespace gnomon
