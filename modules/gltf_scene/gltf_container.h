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
	std::vector<uint8_t> other_chunks; // with their headers, as they were behind the BIN chunk
};

/// Reads either form; the first bytes decide, not the name. Truncated, of another version or not
/// JSON: an Error.
GltfContainer parse_gltf_container(
		std::span<const uint8_t> p_bytes, const GltfMessages &p_messages);
/// The bytes of a .glb file. More than its 32 bits of length: an Error.
std::vector<uint8_t> build_glb(const GltfContainer &p_container, const GltfMessages &p_messages);
/// The text of a .gltf file.
std::string build_gltf_text(const Json &p_json);

} // namespace gnomon
