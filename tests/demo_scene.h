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

// The demo scenes and settings from JSON files, for tests that compare images and masks of them.

namespace gnomon {

/// Tests run from the repository's root; an Error reports if the scene is not found from there.
inline std::unique_ptr<Scene> load_demo_scene(const std::string &p_name) {
	const std::filesystem::path path =
			std::filesystem::path("demo_project/scenes") / (p_name + ".gltf");
	if (!std::filesystem::exists(path)) {
		fail("Scene ", path, " is not there. Run the tests from the repository's root.");
	}
	GltfLoadOptions options;
	options.project_folder = "demo_project";
	options.find_technique_property = &find_added_light_property;
	return load_gltf(path, options);
}

/// Sets the properties of every light. A name that neither Light3D nor a technique of this build
/// declares, or a value out of its range, is an Error.
inline void apply_light_settings(const Scene &p_scene, const nlohmann::json &p_settings) {
	for (const auto &[name, value] : p_settings.items()) {
		const PropertyInfo *info = Light3D::get_property_list().find(name);
		if (info == nullptr) {
			info = find_added_light_property(name);
		}
		if (info == nullptr) {
			fail("Setting \"", name, "\": no light and no technique of this build has it.");
		}
		const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
		for (Light3D *light : p_scene.find_nodes<Light3D>()) {
			light->properties[name] = parse_property(*info, text, "Setting \"" + name + "\"");
		}
	}
}

} // namespace gnomon
