#include "modules/core/png.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/limits.h"

#include <png.h>

#include <algorithm>

namespace gnomon {

std::vector<uint8_t> encode_png(
		const glm::uvec2 &p_size_px, uint32_t p_channel_count, std::span<const uint8_t> p_pixels) {
	if (p_size_px.x < 1 || p_size_px.y < 1 || p_size_px.x > MAX_IMAGE_SIZE_PX ||
			p_size_px.y > MAX_IMAGE_SIZE_PX) {
		fail("the size is ", p_size_px.x, " x ", p_size_px.y, ", must be 1..", MAX_IMAGE_SIZE_PX,
				" on each side.");
	}
	const size_t row_bytes = static_cast<size_t>(p_size_px.x) * p_channel_count;
	GNOMON_ASSERT(p_channel_count >= 1 && p_channel_count <= 4 &&
					p_pixels.size() == row_bytes * p_size_px.y,
			p_pixels.size(), " bytes for ", p_channel_count, " channels");
	const uint32_t formats[] = { PNG_FORMAT_GRAY, PNG_FORMAT_GA, PNG_FORMAT_RGB, PNG_FORMAT_RGBA };
	png_image image = {};
	image.version = PNG_IMAGE_VERSION;
	image.width = p_size_px.x;
	image.height = p_size_px.y;
	image.format = formats[p_channel_count - 1];
	png_alloc_size_t byte_count = PNG_IMAGE_PNG_SIZE_MAX(image);
	std::vector<uint8_t> bytes(byte_count);
	if (png_image_write_to_memory(&image, bytes.data(), &byte_count, /*convert_to_8_bit=*/0,
				p_pixels.data(), static_cast<png_int_32>(row_bytes), /*colormap=*/nullptr) == 0) {
		fail("it cannot be encoded: ", image.message, ". Use a smaller size.");
	}
	bytes.resize(byte_count);
	return bytes;
}

void save_png(const std::filesystem::path &p_path, const glm::uvec2 &p_size_px,
		uint32_t p_channel_count, std::span<const uint8_t> p_pixels) {
	std::vector<uint8_t> bytes;
	try {
		bytes = encode_png(p_size_px, p_channel_count, p_pixels);
	} catch (const Error &error) {
		fail("Image ", p_path, ": ", error.what());
	}
	save_file_atomically(p_path, bytes);
}

} // namespace gnomon
