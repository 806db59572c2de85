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

/// Where a file's URIs point to.
struct GltfLocation {
	std::filesystem::path folder;		  // URIs are relative to it
	std::filesystem::path project_folder; // and may not leave this one
};

bool is_data_uri(std::string_view p_uri);
/// The file that a relative URI names. Another scheme, an absolute path, a wrong escape or a file
/// outside the project folder: fails at p_object's "uri".
std::filesystem::path resolve_uri(
		std::string_view p_uri, const GltfLocation &p_location, const GltfObject &p_object);
/// A file name as a URI.
std::string encode_uri(std::string_view p_file_name);

/// The bytes of a document's buffers, loaded on first use: a file that only images need
/// may be missing.
class GltfBuffers {
public:
	/// All must outlive it. p_bin_chunk is null for the text form.
	GltfBuffers(const GltfObject &p_root, const GltfLocation &p_location,
			const std::vector<uint8_t> *p_bin_chunk);

	/// Exactly byteLength bytes, valid as long as this object; fewer there: fails.
	std::span<const uint8_t> load_buffer(size_t p_index);
	/// The bytes of a buffer view of the document's model; outside its buffer: fails.
	std::span<const uint8_t> load_view(const tinygltf::Model &p_model, size_t p_index);
	/// What a URI of a buffer or image holds, a relative path or base64 data; it cannot be read:
	/// fails at p_object's "uri".
	std::vector<uint8_t> load_uri(const GltfObject &p_object, const std::string &p_uri);
	const GltfObject &get_root() const { return root; }
	/// That were read so far.
	const std::vector<std::filesystem::path> &get_files() const { return files; }

private:
	GltfObject root;
	const GltfLocation &location;
	const std::vector<uint8_t> *bin_chunk;
	std::map<size_t, std::vector<uint8_t>> loaded;
	uint64_t loaded_bytes = 0;
	std::vector<std::filesystem::path> files;
};

} // namespace gnomon
