#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

/// Saves an 8-bit image of 1 (grey), 2 (grey, alpha), 3 (RGB) or 4 (RGBA) channels, top row first.
/// A size that is not 1..16384 on each side or an unwritable path is an Error. A number of bytes
/// that does not match the size is a programming error.
void save_png(const std::filesystem::path &p_path, const glm::uvec2 &p_size_px,
		uint32_t p_channel_count, std::span<const uint8_t> p_pixels);

/// Encodes an image, given as for save_png, as the bytes of a PNG file.
std::vector<uint8_t> encode_png(
		const glm::uvec2 &p_size_px, uint32_t p_channel_count, std::span<const uint8_t> p_pixels);

} // namespace gnomon
