#include "modules/masks/mask_png.h"

#include "modules/core/error.h"
#include "modules/masks/mask_metrics.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

uint8_t to_byte(float p_value) {
	return static_cast<uint8_t>(std::lround(std::clamp(p_value, 0.0f, 1.0f) * 255.0f));
}

glm::u8vec3 compute_heat_map_color(float p_error) {
	const float error = p_error / HEAT_MAP_RANGE;
	const uint8_t other_channels = to_byte(1.0f - std::abs(error));
	return { error > 0 ? 255 : other_channels, other_channels, error > 0 ? other_channels : 255 };
}

} // namespace

std::vector<uint8_t> compute_mask_pixels(const MaskImage &p_image) {
	std::vector<uint8_t> pixels(p_image.get_pixel_count(), 0);
	for (size_t i = 0; i < pixels.size(); ++i) {
		if (!std::isfinite(p_image.visibility[i])) {
			fail("Image of a mask: pixel (", i % p_image.size_px.x, ", ", i / p_image.size_px.x,
					") is ", p_image.visibility[i], ", must be finite.");
		}
		pixels[i] = p_image.is_receiver(i) ? to_byte(p_image.visibility[i]) : 0;
	}
	return pixels;
}

std::vector<uint8_t> compute_error_pixels(const MaskImage &p_reference, const MaskImage &p_result) {
	compute_mask_metrics(p_reference, p_result); // checks size, receivers, finite values
	std::vector<uint8_t> pixels;
	pixels.reserve(3 * p_reference.get_pixel_count());
	for (size_t i = 0; i < p_reference.get_pixel_count(); ++i) {
		if (!p_reference.is_receiver(i)) {
			pixels.insert(pixels.end(), 3, HEAT_MAP_NO_RECEIVER);
			continue;
		}
		const glm::u8vec3 color =
				compute_heat_map_color(p_result.visibility[i] - p_reference.visibility[i]);
		pixels.insert(pixels.end(), { color.x, color.y, color.z });
	}
	return pixels;
}

std::vector<glm::u8vec3> compute_heat_map_colors(uint32_t p_count) {
	std::vector<glm::u8vec3> colors;
	for (uint32_t index = 0; index < p_count; ++index) {
		colors.push_back(compute_heat_map_color(
				HEAT_MAP_RANGE * (2.0f * float(index) / float(p_count - 1) - 1.0f)));
	}
	return colors;
}

void save_mask_png(const std::filesystem::path &p_path, const MaskImage &p_image) {
	save_png(p_path, p_image.size_px, /*p_channel_count=*/1, compute_mask_pixels(p_image));
}

void save_error_png(const std::filesystem::path &p_path, const MaskImage &p_reference,
		const MaskImage &p_result) {
	save_png(p_path, p_reference.size_px, /*p_channel_count=*/3,
			compute_error_pixels(p_reference, p_result));
}

} // namespace gnomon
