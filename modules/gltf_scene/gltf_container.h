#pragma once

#include "modules/gltf_scene/gltf_json.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

enum class GltfFormat { TEXT, BINARY }; // .gltf, .glb

/// The contents of a glTF file in either form: JSON text (.gltf), or binary (.glb) with chunks for
/// the JSON and for buffer 0.
struct GltfContainer {
	GltfFormat format = GltfFormat::TEXT;
	std::string json_text; // in the binary form with the spaces that fill its chunk
	std::optional<std::vector<uint8_t>> bin_chunk; // binary form only
	/// All chunks other than JSON and BIN, unchanged and with their headers. Binary form only.
	std::vector<uint8_t> other_chunks;
};

/// Splits either form. The first bytes determine the form, not the file's name. Throws an Error for
/// truncated data or another container version. The JSON is not parsed.
GltfContainer parse_gltf_container(
		std::span<const uint8_t> p_bytes, const GltfMessages &p_messages);
/// Builds the bytes of a .glb file. Throws an Error if the size exceeds 32 bits.
std::vector<uint8_t> build_glb(const GltfContainer &p_container, const GltfMessages &p_messages);

} // namespace gnomon
