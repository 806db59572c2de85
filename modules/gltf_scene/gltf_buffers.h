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

/// Where the URIs of a file are resolved.
struct GltfLocation {
	std::filesystem::path folder;		  // URIs are relative to it
	std::filesystem::path project_folder; // and may not leave this one
};

bool is_data_uri(std::string_view p_uri);
/// Resolves a relative URI to a file. Another scheme, an absolute path, an invalid escape, or a
/// file outside the project folder fails at p_object's "uri".
std::filesystem::path resolve_uri(
		std::string_view p_uri, const GltfLocation &p_location, const GltfObject &p_object);
/// Encodes a file name as a URI.
std::string encode_uri(std::string_view p_file_name);

/// The bytes of a document's buffers, loaded on first use: a file that only images need
/// may be missing.
class GltfBuffers {
public:
	/// The arguments must outlive this object. p_bin_chunk is null for the text form.
	GltfBuffers(const GltfObject &p_root, const GltfLocation &p_location,
			const std::vector<uint8_t> *p_bin_chunk);

	/// Returns exactly byteLength bytes, valid as long as this object; fails if the buffer is
	/// shorter.
	std::span<const uint8_t> load_buffer(size_t p_index);
	/// Returns the bytes of a buffer view; fails if the view exceeds its buffer.
	std::span<const uint8_t> load_view(const tinygltf::Model &p_model, size_t p_index);
	/// Loads the URI of a buffer or image, a relative path or base64 data; fails at p_object's
	/// "uri" if it cannot be read.
	std::vector<uint8_t> load_uri(const GltfObject &p_object, const std::string &p_uri);
	const GltfObject &get_root() const { return root; }
	/// Returns the files read so far.
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
