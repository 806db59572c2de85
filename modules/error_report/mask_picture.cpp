#include "modules/error_report/mask_picture.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/error_report/mask_metrics.h"

#include <stb/stb_image_write.h>

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

uint8_t to_byte(float p_value) {
	return static_cast<uint8_t>(std::lround(std::clamp(p_value, 0.0f, 1.0f) * 255.0f));
}

void append_bytes(void *r_bytes, void *p_data, int p_count) {
	const uint8_t *data = static_cast<const uint8_t *>(p_data);
	std::vector<uint8_t> &bytes = *static_cast<std::vector<uint8_t> *>(r_bytes);
	bytes.insert(bytes.end(), data, data + p_count);
}

glm::u8vec3 compute_heat_map_color(float p_error) {
	const float error = p_error / HEAT_MAP_RANGE;
	const uint8_t rest = to_byte(1.0f - std::abs(error));
	return { error > 0 ? 255 : rest, rest, error > 0 ? rest : 255 };
}

} // namespace

std::vector<uint8_t> compute_mask_pixels(const MaskImage &p_image) {
	std::vector<uint8_t> pixels(p_image.get_pixel_count(), 0);
	for (size_t i = 0; i < pixels.size(); ++i) {
		if (!std::isfinite(p_image.visibility[i])) {
			fail("Picture of a mask: pixel (", i % p_image.size_px.x, ", ", i / p_image.size_px.x,
					") is ", p_image.visibility[i], ", must be finite.");
		}
		pixels[i] = p_image.is_receiver(i) ? to_byte(p_image.visibility[i]) : 0;
	}
	return pixels;
}

std::vector<uint8_t> compute_error_pixels(const MaskImage &p_truth, const MaskImage &p_result) {
	compute_mask_metrics(p_truth, p_result); // its checks: size, receivers, finite values
	std::vector<uint8_t> pixels;
	pixels.reserve(3 * p_truth.get_pixel_count());
	for (size_t i = 0; i < p_truth.get_pixel_count(); ++i) {
		if (!p_truth.is_receiver(i)) {
			pixels.insert(pixels.end(), 3, HEAT_MAP_NO_RECEIVER);
			continue;
		}
		const glm::u8vec3 color =
				compute_heat_map_color(p_result.visibility[i] - p_truth.visibility[i]);
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

std::vector<uint8_t> encode_png(
		const glm::uvec2 &p_size_px, uint32_t p_channel_count, std::span<const uint8_t> p_pixels) {
	if (p_size_px.x < 1 || p_size_px.y < 1 || p_size_px.x > MaskImage::MAX_SIZE_PX ||
			p_size_px.y > MaskImage::MAX_SIZE_PX) {
		fail("the size is ", p_size_px.x, " x ", p_size_px.y, ", must be 1..",
				MaskImage::MAX_SIZE_PX, " on each side.");
	}
	const size_t row_bytes = static_cast<size_t>(p_size_px.x) * p_channel_count;
	GNOMON_ASSERT(p_channel_count >= 1 && p_channel_count <= 4 &&
					p_pixels.size() == row_bytes * p_size_px.y,
			p_pixels.size(), " bytes for ", p_channel_count, " channels");
	std::vector<uint8_t> bytes;
	const int is_written = stbi_write_png_to_func(append_bytes, &bytes,
			static_cast<int>(p_size_px.x), static_cast<int>(p_size_px.y),
			static_cast<int>(p_channel_count), p_pixels.data(), static_cast<int>(row_bytes));
	if (is_written == 0 || bytes.empty()) {
		fail("it cannot be encoded, memory is short. Use a smaller size.");
	}
	return bytes;
}

void save_png(const std::filesystem::path &p_path, const glm::uvec2 &p_size_px,
		uint32_t p_channel_count, std::span<const uint8_t> p_pixels) {
	std::vector<uint8_t> bytes;
	try {
		bytes = encode_png(p_size_px, p_channel_count, p_pixels);
	} catch (const Error &error) {
		fail("Picture ", p_path, ": ", error.what());
	}
	save_file_atomically(p_path, bytes);
}

void save_mask_png(const std::filesystem::path &p_path, const MaskImage &p_image) {
	save_png(p_path, p_image.size_px, 1, compute_mask_pixels(p_image));
}

void save_error_png(
		const std::filesystem::path &p_path, const MaskImage &p_truth, const MaskImage &p_result) {
	save_png(p_path, p_truth.size_px, 3, compute_error_pixels(p_truth, p_result));
}

} // namespace gnomon
