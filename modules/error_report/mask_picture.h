#pragma once

#include "modules/error_report/mask_image.h"

#include "shared/heat_map_shared.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

/// 8-bit grey, 0 black .. 1 white, linear as stored (255 v rounded, clamped); no receiver is black.
/// A value that is not finite is an Error; so is an empty image or an unwritable path.
void save_mask_png(const std::filesystem::path &p_path, const MaskImage &p_image);

/// Result minus truth in the colours of shared/heat_map_shared.h, as the renderer's error view.
/// Errors as in compute_mask_metrics.
void save_error_png(
		const std::filesystem::path &p_path, const MaskImage &p_truth, const MaskImage &p_result);

/// Any 8-bit picture of 1 (grey), 2 (grey, alpha), 3 (RGB) or 4 (RGBA) channels, rows from the top.
void save_png(const std::filesystem::path &p_path, const glm::uvec2 &p_size_px,
		uint32_t p_channel_count, std::span<const uint8_t> p_pixels);

/// The bytes of such a file.
std::vector<uint8_t> encode_png(
		const glm::uvec2 &p_size_px, uint32_t p_channel_count, std::span<const uint8_t> p_pixels);

/// The colours of errors from -HEAT_MAP_RANGE to HEAT_MAP_RANGE in equal steps, RGB.
std::vector<glm::u8vec3> compute_heat_map_colors(uint32_t p_count);

/// The pixels that the two functions above write: grey, and RGB.
std::vector<uint8_t> compute_mask_pixels(const MaskImage &p_image);
std::vector<uint8_t> compute_error_pixels(const MaskImage &p_truth, const MaskImage &p_result);

} // namespace gnomon
