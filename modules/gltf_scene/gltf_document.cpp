#include "modules/gltf_scene/gltf_document.h"

#include "modules/core/error.h"

namespace gnomon {

namespace {

/// The members that tinygltf parses. It does not get the others: it would load buffers and images,
/// and the program reads the rest from the JSON.
const char *const PARSED_MEMBERS[] = { "asset", "bufferViews", "accessors", "meshes", "nodes",
	"scenes", "scene", "skins", "animations" };

/// Removes compressed copies of meshes, because tinygltf would decode them.
void remove_compressed_meshes(Json &r_json) {
	for (Json &mesh : r_json["meshes"]) {
		for (Json &primitive : mesh["primitives"]) {
			const auto extensions = primitive.find("extensions");
			if (extensions != primitive.end() && extensions->is_object()) {
				extensions->erase("KHR_draco_mesh_compression");
			}
		}
	}
}

} // namespace

tinygltf::Model parse_gltf_model(Json &r_checked, const GltfMessages &p_messages) {
	remove_compressed_meshes(r_checked);
	std::string json;
	for (const char *name : PARSED_MEMBERS) {
		const auto member = r_checked.find(name);
		if (member != r_checked.end() && !member->is_null()) {
			if (member->is_structured()) {
				convert_whole_numbers(*member); // tinygltf rejects an index such as 3.0
			}
			json += text(json.empty() ? "{" : ",", "\"", name, "\":", member->dump());
		}
	}
	json += "}";
	tinygltf::TinyGLTF parser;
	tinygltf::Model model;
	std::string problem;
	std::string warning;
	if (!parser.LoadASCIIFromString(&model, &problem, &warning, json.data(),
				static_cast<unsigned>(json.size()),
				/*base_dir=*/"")) {
		throw Error(p_messages.describe(
				"JSON", text("is not valid: ", problem, " Correct it or export the file again.")));
	}
	return model;
}

} // namespace gnomon
