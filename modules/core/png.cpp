#include "modules/core/png.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/limits.h"

#include <stb/stb_image_write.h>

namespace gnomon {

namespace {

void append_bytes(void *r_bytes, void *p_data, int p_count) {
	const uint8_t *data = static_cast<const uint8_t *>(p_data);
	std::vector<uint8_t> &bytes = *static_cast<std::vector<uint8_t> *>(r_bytes);
	bytes.insert(bytes.end(), data, data + p_count);
}

} // namespace

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
	std::vector<uint8_t> bytes;
	const int is_written = stbi_write_png_to_func(append_bytes, &bytes,
			static_cast<int>(p_size_px.x), static_cast<int>(p_size_px.y),
			static_cast<int>(p_channel_count), p_pixels.data(), static_cast<int>(row_bytes));
	if (is_written == 0 || bytes.empty()) {
		fail("it cannot be encoded: out of memory. Use a smaller size.");
	}
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
