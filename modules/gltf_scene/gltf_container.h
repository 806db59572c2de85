#pragma once

#include "modules/gltf_scene/gltf_json.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gnomon {

/// The contents of a glTF file in either form: JSON text (.gltf), or binary (.glb) with chunks for
/// the JSON and for buffer 0.
struct GltfContainer {
	Json json;
	std::optional<std::vector<uint8_t>> bin_chunk; // binary form only
	/// All chunks other than JSON and BIN, unchanged and with their headers. Binary form only.
	std::vector<uint8_t> other_chunks;
};

/// Parses either form. The first bytes determine the form, not the file's name. Throws an Error for
/// truncated data, another container version or invalid JSON.
GltfContainer parse_gltf_container(
		std::span<const uint8_t> p_bytes, const GltfMessages &p_messages);
/// Builds the bytes of a .glb file. Throws an Error if the size exceeds 32 bits.
std::vector<uint8_t> build_glb(const GltfContainer &p_container, const GltfMessages &p_messages);
/// Builds the text of a .gltf file.
std::string build_gltf_text(const Json &p_json);

} // namespace gnomon
