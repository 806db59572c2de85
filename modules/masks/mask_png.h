#pragma once

#include "modules/core/png.h"
#include "modules/masks/mask_image.h"

#include "shared/heat_map_shared.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace gnomon {

/// Saves 8-bit grey, 0 black .. 1 white, linear (255 v rounded, clamped); pixels without a receiver
/// are black. A value that is not finite, an empty image or an unwritable path is an Error.
void save_mask_png(const std::filesystem::path &p_path, const MaskImage &p_image);

/// Saves result minus reference in the colours of shared/heat_map_shared.h, like the renderer's
/// error view. Errors as in compute_mask_metrics.
void save_error_png(const std::filesystem::path &p_path, const MaskImage &p_reference,
		const MaskImage &p_result);

/// Returns the colours of errors from -HEAT_MAP_RANGE to HEAT_MAP_RANGE in equal steps, RGB.
/// p_count: at least 2.
std::vector<glm::u8vec3> compute_heat_map_colors(uint32_t p_count);

/// Compute the pixels that save_mask_png (grey) and save_error_png (RGB) write. Values that these
/// functions reject are an Error here too.
std::vector<uint8_t> compute_mask_pixels(const MaskImage &p_image);
std::vector<uint8_t> compute_error_pixels(const MaskImage &p_reference, const MaskImage &p_result);

} // namespace gnomon
