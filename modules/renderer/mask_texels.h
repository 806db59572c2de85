#pragma once

#include "modules/rendering_device/resource_types.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

// A mask's texels on the CPU.

namespace gnomon {

/// The colours of a mask that has three, else none.
std::vector<glm::vec3> read_mask_colors(
		const std::vector<uint8_t> &p_bytes, Format p_format, size_t p_count);
/// The values of a mask that has one. Another format is our mistake.
std::vector<float> read_mask(const std::vector<uint8_t> &p_bytes, Format p_format, size_t p_count);

} // namespace gnomon
