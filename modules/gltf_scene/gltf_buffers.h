#pragma once

#include "modules/gltf_scene/gltf_json.h"

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon {

/// The folders against which the URIs of a file are resolved.
struct GltfLocation {
	std::filesystem::path folder;		  // folder of the file; URIs are relative to it
	std::filesystem::path project_folder; // every resolved path must be inside it
};

/// Returns whether the URI contains its data ("data:...").
bool is_data_uri(std::string_view p_uri);
/// Resolves a relative URI to a file path. Throws an Error about p_object's "uri" if it has a
/// scheme, is an absolute path, has an invalid % escape or leads out of the project folder.
std::filesystem::path resolve_uri(
		std::string_view p_uri, const GltfLocation &p_location, const GltfObject &p_object);
/// Encodes a file name as a URI, with % escapes.
std::string encode_uri(std::string_view p_file_name);

/// Loads the bytes of a document's buffers, each on first use. A buffer file that only images use
/// may therefore be missing without failing the load.
class GltfBuffers {
public:
	/// The arguments must outlive this object. p_bin_chunk: the BIN chunk of a .glb file; null for
	/// a .gltf file.
	GltfBuffers(const GltfObject &p_root, const GltfLocation &p_location,
			const std::vector<uint8_t> *p_bin_chunk);

	/// Returns exactly byteLength bytes, which are valid as long as this object. Throws an Error if
	/// the buffer is shorter.
	std::span<const uint8_t> load_buffer(size_t p_index);
	/// Returns the bytes of a buffer view. Throws an Error if the view exceeds its buffer.
	std::span<const uint8_t> load_view(const tinygltf::Model &p_model, size_t p_index);
	/// Loads the data of a buffer or image from its URI, a relative path or base64 data. Throws an
	/// Error about p_object's "uri" if it cannot be read.
	std::vector<uint8_t> load_uri(const GltfObject &p_object, const std::string &p_uri);
	/// Returns the external files requested so far, including those that could not be read.
	const std::vector<std::filesystem::path> &get_files() const { return files; }

private:
	GltfObject root;
	const GltfLocation &location;
	const std::vector<uint8_t> *bin_chunk;
	std::map<size_t, std::vector<uint8_t>> loaded; // by index of the buffer
	uint64_t loaded_bytes = 0;
	std::vector<std::filesystem::path> files;
};

} // namespace gnomon
