#include "modules/renderer/mask_texels.h"

#include "modules/core/error.h"

#include <glm/gtc/packing.hpp>

#include <cstring>

namespace gnomon {

std::vector<glm::vec3> read_mask_colors(
		const std::vector<uint8_t> &p_bytes, Format p_format, size_t p_count) {
	std::vector<glm::vec3> colors;
	for (size_t index = 0; p_format == Format::RGBA16_SFLOAT && index < p_count; ++index) {
		uint64_t halves = 0;
		std::memcpy(&halves, p_bytes.data() + 8 * index, sizeof(halves));
		colors.push_back(glm::vec3(glm::unpackHalf4x16(halves)));
	}
	for (size_t index = 0; p_format == Format::RGBA32_SFLOAT && index < p_count; ++index) {
		glm::vec4 color;
		std::memcpy(&color, p_bytes.data() + sizeof(color) * index, sizeof(color));
		colors.push_back(glm::vec3(color));
	}
	return colors;
}

std::vector<float> read_mask(const std::vector<uint8_t> &p_bytes, Format p_format, size_t p_count) {
	std::vector<float> values(p_count);
	if (p_format == Format::R32_SFLOAT) {
		std::memcpy(values.data(), p_bytes.data(), p_count * sizeof(float));
		return values;
	}
	GNOMON_ASSERT(p_format == Format::R16_SFLOAT, "mask of format ", get_format_name(p_format));
	for (size_t index = 0; index < p_count; ++index) {
		uint16_t half = 0;
		std::memcpy(&half, p_bytes.data() + 2 * index, sizeof(half));
		values[index] = glm::unpackHalf1x16(half);
	}
	return values;
}

} // namespace gnomon
