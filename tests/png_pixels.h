#pragma once

#include "modules/core/error.h"
#include "modules/core/files.h"

#include <glm/glm.hpp>
#include <png.h>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace gnomon {

/// The pixels of a PNG file with 8 bits per channel, top row first.
struct PngPixels {
	glm::uvec2 size_px = glm::uvec2(0);
	uint32_t channel_count = 0;
	std::vector<uint8_t> values;
};

/// Loads a PNG file. p_channel_count: 1 to 4, to which the pixels are converted; 0: as in the file.
/// Throws an Error if it cannot be read.
inline PngPixels load_png_pixels(const std::filesystem::path &p_path, uint32_t p_channel_count) {
	const std::vector<uint8_t> bytes = load_file(p_path);
	png_image image = {};
	image.version = PNG_IMAGE_VERSION;
	PngPixels pixels;
	if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) != 0) {
		const uint32_t formats[] = { PNG_FORMAT_GRAY, PNG_FORMAT_GA, PNG_FORMAT_RGB,
			PNG_FORMAT_RGBA };
		image.format = p_channel_count == 0 ? image.format : formats[p_channel_count - 1];
		pixels.size_px = { image.width, image.height };
		pixels.channel_count = PNG_IMAGE_PIXEL_CHANNELS(image.format);
		pixels.values.resize(PNG_IMAGE_SIZE(image));
		png_image_finish_read(&image, /*background=*/nullptr, pixels.values.data(),
				/*row_stride=*/0, /*colormap=*/nullptr);
	}
	if (PNG_IMAGE_FAILED(image)) {
		fail("Image ", p_path, " cannot be read: ", image.message, ".");
	}
	return pixels;
}

} // namespace gnomon
