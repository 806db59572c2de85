#pragma once

#include "modules/core/limits.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

/// The visibility mask of one light: one value per camera pixel, top row first.
struct MaskImage {
	glm::uvec2 size_px = glm::uvec2(0u);
	std::vector<float> visibility; // linear, 0 hidden .. 1 lit; 0 where there is no receiver
	std::vector<float> receiver;   // 1 on receiver pixels, else 0

	size_t get_pixel_count() const { return static_cast<size_t>(size_px.x) * size_px.y; }
	bool is_receiver(size_t p_pixel) const { return receiver[p_pixel] >= 0.5f; }
};

/// Writes an OpenEXR file of two float32 channels, "Y" = visibility and "receiver", ZIP compressed;
/// the file is written atomically. An empty image, one above MAX_IMAGE_SIZE_PX or an unwritable
/// path is an Error.
void save_mask_exr(const std::filesystem::path &p_path, const MaskImage &p_image);

/// Reads a file that save_mask_exr wrote. Other channels are ignored and half floats widened. A
/// file that is missing, damaged or truncated, lacks a channel (named in the message), has a
/// subsampled channel or is larger than MAX_IMAGE_SIZE_PX is an Error naming the file. Pixel
/// values are not checked.
MaskImage load_mask_exr(const std::filesystem::path &p_path);

/// Encode to and decode from bytes in memory, with the same errors; p_name replaces the file name
/// in messages.
std::vector<uint8_t> encode_mask_exr(const MaskImage &p_image, const std::string &p_name);
MaskImage decode_mask_exr(std::span<const uint8_t> p_bytes, const std::string &p_name);

} // namespace gnomon
