#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/gltf_scene/gltf_document.h"
#include "modules/gltf_scene/gltf_json_text.h"
#include "modules/gltf_scene/gltf_mesh_writer.h"
#include "modules/gltf_scene/gltf_node_writer.h"
#include "modules/gltf_scene/gltf_scene.h"
#include "modules/gltf_scene/gltf_side_files.h"

#include <algorithm>

namespace gnomon {

namespace fs = std::filesystem;

namespace {

GltfFormat choose_format(const fs::path &p_path) {
	std::string extension = p_path.extension().string();
	std::transform(extension.begin(), extension.end(), extension.begin(),
			[](unsigned char p_letter) { return static_cast<char>(std::tolower(p_letter)); });
	if (extension != ".gltf" && extension != ".glb") {
		fail("\"", p_path.string(), "\" must end in .gltf or .glb. Choose another name.");
	}
	return extension == ".glb" ? GltfFormat::BINARY : GltfFormat::TEXT;
}

const char GENERATOR[] = "Gnomon";

Json make_empty_json() {
	return { { "asset", { { "version", "2.0" }, { "generator", GENERATOR } } }, { "scene", 0 },
		{ "scenes", Json::array({ Json::object() }) } };
}

/// Where the bytes of new meshes are stored: after the existing bytes of the BIN chunk, or in a new
/// buffer.
struct NewBuffer {
	size_t index = 0;		  // of the buffer
	size_t first_byte = 0;	  // offset in the buffer, a multiple of 4
	bool is_in_chunk = false; // whether the buffer is the BIN chunk
};

NewBuffer choose_buffer(const Json &p_json, const GltfContainer &p_container, GltfFormat p_format) {
	const auto buffers = p_json.find("buffers");
	const size_t count = buffers == p_json.end() ? 0 : buffers->size();
	NewBuffer chosen{ .index = count, .first_byte = 0, .is_in_chunk = false };
	if (p_format == GltfFormat::BINARY && p_container.bin_chunk && count > 0) {
		chosen = { .index = 0,
			.first_byte = (p_container.bin_chunk->size() + 3) / 4 * 4,
			.is_in_chunk = true };
	} else if (p_format == GltfFormat::BINARY && count == 0) {
		chosen = { .index = 0, .first_byte = 0, .is_in_chunk = true };
	}
	return chosen;
}

/// Returns the buffer file that an earlier save of a generated scene wrote next to p_path; an empty
/// path if there is none.
fs::path find_previous_buffer(const fs::path &p_path) {
	const size_t MAX_NAME_COUNT = 100; // a buffer file with a higher number is left in the folder
	std::error_code code;
	if (!fs::is_regular_file(p_path, code)) {
		return {};
	}
	try {
		const Json json = Json::parse(load_text_file(p_path, GLTF_MAX_FILE_BYTES));
		if (json.at("asset").at("generator") != GENERATOR) {
			return {};
		}
		const Json &uri = json.at("buffers").at(0).at("uri");
		for (size_t number = 1; number < MAX_NAME_COUNT; ++number) {
			const std::string name =
					GltfSideFiles::make_numbered_name(p_path.stem().string() + ".bin", number);
			if (uri == encode_uri(name)) {
				return fs::absolute(p_path).parent_path() / make_path(name);
			}
		}
	} catch (const Json::exception &) {
		// The file is not in the form that this program writes.
	} catch (const Error &) {
		// The file cannot be read.
	}
	return {};
}

/// Stores the bytes of new meshes in p_buffer: in the BIN chunk, or in a file added to r_files.
void store_bytes(const NewBuffer &p_buffer, const std::vector<uint8_t> &p_bytes,
		const fs::path &p_path, Json &r_json, GltfContainer &r_container, GltfSideFiles &r_files) {
	if (p_bytes.empty()) {
		return;
	}
	Json &buffers = r_json["buffers"];
	if (buffers.size() <= p_buffer.index) {
		buffers.push_back(Json::object());
	}
	Json &buffer = buffers[p_buffer.index];
	buffer["byteLength"] = p_buffer.first_byte + p_bytes.size();
	if (p_buffer.is_in_chunk) {
		std::vector<uint8_t> &chunk =
				r_container.bin_chunk ? *r_container.bin_chunk : r_container.bin_chunk.emplace();
		chunk.resize(p_buffer.first_byte, 0);
		chunk.insert(chunk.end(), p_bytes.begin(), p_bytes.end());
		return;
	}
	// If the bytes differ, so does the name from that of the old buffer, which the old scene file
	// needs until it is replaced.
	buffer["uri"] = encode_uri(r_files.add(p_path.stem().string() + ".bin", p_bytes));
}

/// Returns the changed JSON as text. What did not change keeps its text if p_document is a file in
/// the same format; null: a new document. Throws an Error if a name is not UTF-8.
std::string build_json_text(const Json &p_json, GltfFormat p_format, const GltfDocument *p_document,
		const Json &p_loaded) {
	try {
		if (!p_document || p_document->container.format != p_format) {
			return p_format == GltfFormat::BINARY ? p_json.dump() : p_json.dump(1, '\t') + "\n";
		}
		std::string json = update_json_text(p_document->container.json_text, p_loaded, p_json);
		if (p_format == GltfFormat::BINARY && p_json != p_loaded) {
			json.erase(json.find_last_of('}') + 1); // spaces that filled the chunk
		}
		return json;
	} catch (const Json::exception &error) {
		fail("The scene cannot be saved: ", to_one_line(error.what()),
				". Change the names of its nodes to plain text.");
	}
}

std::set<const Material *> find_materials(const Scene &p_scene) {
	std::set<const Material *> materials;
	for (const MeshInstance3D *instance : p_scene.find_nodes<MeshInstance3D>()) {
		for (const MeshInstance3D::Surface &surface : instance->surfaces) {
			materials.insert(surface.material.get());
		}
	}
	return materials;
}

} // namespace

void save_gltf(const Scene &p_scene, const fs::path &p_path) {
	const GltfFormat format = choose_format(p_path);
	const auto *document = dynamic_cast<const GltfDocument *>(p_scene.document.get());
	const GltfMessages messages{ p_path.string(), {} };
	GltfSideFiles files(fs::absolute(p_path).parent_path());
	GltfContainer container;
	Json loaded;
	Json json = make_empty_json();
	if (document) {
		container = document->container;
		json = loaded = parse_gltf_json(container.json_text, messages);
		relocate_container(*document, p_path, format, json, container, files);
	}
	const NewBuffer buffer = choose_buffer(json, container, format);
	GltfMeshWriter meshes(
			document, loaded, json, buffer.index, buffer.first_byte, find_materials(p_scene));
	GltfNodeWriter(document, loaded, json, meshes).write(p_scene);
	store_bytes(buffer, meshes.get_bytes(), p_path, json, container, files);
	container.json_text = build_json_text(json, format, document, loaded);
	const fs::path old_buffer = document ? fs::path() : find_previous_buffer(p_path);
	files.save();
	if (format == GltfFormat::BINARY) {
		save_file_atomically(p_path, build_glb(container, messages));
	} else {
		save_file_atomically(p_path, container.json_text);
	}
	if (!old_buffer.empty() && !files.contains(old_buffer.filename().string())) {
		std::error_code code;
		fs::remove(old_buffer, code); // no longer needed
	}
}

} // namespace gnomon
