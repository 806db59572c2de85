#pragma once

#include "modules/core/limits.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

/// What a technique answers for one light: one value per camera pixel, rows from the top.
struct MaskImage {
	glm::uvec2 size_px = glm::uvec2(0u);
	std::vector<float> visibility; // linear, 0 hidden .. 1 lit; 0 where there is no receiver
	std::vector<float> receiver;   // 1 on receiver pixels, else 0

	size_t get_pixel_count() const { return static_cast<size_t>(size_px.x) * size_px.y; }
	bool is_receiver(size_t p_pixel) const { return receiver[p_pixel] >= 0.5f; }
};

/// Writes an OpenEXR file of two float32 channels, "Y" = visibility and "receiver", ZIP compressed;
/// whole or not at all. An empty image, one above MAX_IMAGE_SIZE_PX and an unwritable path are an
/// Error.
void save_mask_exr(const std::filesystem::path &p_path, const MaskImage &p_image);

/// Reads what save_mask_exr writes. Other channels are ignored and half floats widened. A file that
/// is missing, damaged or cut short, lacks a channel (named in the text), stores one at a lower
/// resolution or is larger than MAX_IMAGE_SIZE_PX: an Error naming the file. Values are not checked
/// here.
MaskImage load_mask_exr(const std::filesystem::path &p_path);

/// The same for bytes in memory; p_name is used for the file in messages.
std::vector<uint8_t> encode_mask_exr(const MaskImage &p_image, const std::string &p_name);
MaskImage decode_mask_exr(std::span<const uint8_t> p_bytes, const std::string &p_name);

} // namespace gnomon
