#pragma once

#include "modules/core/error.h"
#include "modules/core/property.h"
#include "modules/gltf_scene/gltf_scene.h"
#include "modules/scene/nodes.h"
#include "modules/shadows/light_properties.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <memory>
#include <string>

// Loads demo scenes and applies settings from JSON, for tests that compare images and masks.

namespace gnomon {

/// Loads demo_project/scenes/<p_name>.gltf. Tests must run from the repository's root. Throws Error
/// if the file does not exist.
inline std::unique_ptr<Scene> load_demo_scene(const std::string &p_name) {
	const std::filesystem::path path =
			std::filesystem::path("demo_project/scenes") / (p_name + ".gltf");
	if (!std::filesystem::exists(path)) {
		fail("Scene ", path, " does not exist. Run the tests from the repository's root.");
	}
	GltfLoadOptions options;
	options.project_folder = "demo_project";
	options.find_technique_property = &find_added_light_property;
	return load_gltf(path, options);
}

/// Sets properties of every light. p_settings: name -> value. Throws Error for a name that neither
/// Light3D nor a technique or mask filter of this build declares, and for a value out of its range.
inline void apply_light_settings(const Scene &p_scene, const nlohmann::json &p_settings) {
	for (const auto &[name, value] : p_settings.items()) {
		const PropertyInfo *info = Light3D::get_property_list().find(name);
		if (info == nullptr) {
			info = find_added_light_property(name);
		}
		if (info == nullptr) {
			fail("Setting \"", name,
					"\": no light, technique or mask filter of this build has this property.");
		}
		const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
		for (Light3D *light : p_scene.find_nodes<Light3D>()) {
			light->properties[name] = parse_property(*info, text, "Setting \"" + name + "\"");
		}
	}
}

} // namespace gnomon
