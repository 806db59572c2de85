#include "modules/gltf_scene/gltf_header.h"

#include "modules/core/error.h"

namespace gnomon {

namespace {

/// Extensions that change nothing that is read here, or are read.
bool is_known_extension(std::string_view p_name) {
	return p_name == "KHR_lights_punctual" || p_name == "EXT_lights_area" ||
			p_name.starts_with("KHR_materials_") || p_name == "KHR_texture_transform" ||
			p_name == "KHR_mesh_quantization";
}

} // namespace

void check_gltf_header(const GltfObject &p_root) {
	const GltfObject asset = p_root.require_object("asset");
	const std::string version = asset.get_text("version");
	if (!version.starts_with("2.")) {
		asset.fail_value("version", "\"2.0\"");
	}
	if (asset.find("minVersion") && asset.get_text("minVersion") != "2.0") {
		asset.fail_value("minVersion", "\"2.0\"");
	}
	const size_t required_count = p_root.get_count("extensionsRequired");
	for (size_t index = 0; index < required_count; ++index) {
		const Json &name = (*p_root.find("extensionsRequired"))[index];
		if (!name.is_string() || !is_known_extension(name.get_ref<const std::string &>())) {
			p_root.fail_at(text("extensionsRequired[", index, "]"),
					text("is ", describe_json(name),
							", which is not supported. Export the file without it."));
		}
	}
	GltfMessages &messages = p_root.get_messages();
	if (p_root.get_count("animations") > 0) {
		messages.warn("animations", "animations", "are not read.");
	}
	if (p_root.get_count("skins") > 0) {
		messages.warn("skins", "skins", "are not read.");
	}
}

} // namespace gnomon
