#pragma once

#include "modules/gltf_scene/gltf_json.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gnomon {

/// The two forms of a glTF file: JSON text, or a binary with JSON and buffer 0 in chunks.
struct GltfContainer {
	Json json;
	std::optional<std::vector<uint8_t>> bin_chunk; // binary form only
	/// Chunks after the BIN chunk, unchanged and with their headers.
	std::vector<uint8_t> other_chunks;
};

/// Parses either form, decided by the first bytes and not by the name. Truncated data, another glTF
/// version or invalid JSON is an Error.
GltfContainer parse_gltf_container(
		std::span<const uint8_t> p_bytes, const GltfMessages &p_messages);
/// Builds the bytes of a .glb file. A size that exceeds 32 bits is an Error.
std::vector<uint8_t> build_glb(const GltfContainer &p_container, const GltfMessages &p_messages);
/// Builds the text of a .gltf file.
std::string build_gltf_text(const Json &p_json);

} // namespace gnomon
