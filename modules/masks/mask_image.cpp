#include "modules/masks/mask_image.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/masks/exr_header.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>

#include <algorithm>
#include <cstring>
#include <mutex>

namespace gnomon {

namespace {

constexpr const char *VISIBILITY_CHANNEL = "Y";
constexpr const char *RECEIVER_CHANNEL = "receiver";
/// A header that claims more pixels than this per byte of the file is damaged, which is detected
/// before memory is allocated: Deflate compresses at most 1032 to 1, and a pixel has at least 4
/// bytes (two half floats), so that a byte holds at most 258 pixels. The limit is the next power of
/// two.
constexpr uint64_t MAX_PIXELS_PER_BYTE = 512;
/// Twice the largest mask of save_mask_exr without compression: 16384 x 16384 pixels of 8 bytes.
constexpr uint64_t FILE_LIMIT_BYTES = uint64_t(1) << 32;

/// A stream that reads bytes in memory, the first of them from a replacement: the checked header.
class MemoryInput : public Imf::IStream {
public:
	MemoryInput(std::span<const uint8_t> p_bytes, std::vector<uint8_t> p_header) :
			Imf::IStream("memory"), bytes(p_bytes), header(std::move(p_header)) {}
	bool read(char r_data[], int p_count) override {
		const size_t count = static_cast<size_t>(std::max(p_count, 0));
		if (position > bytes.size() || count > bytes.size() - position) {
			throw std::runtime_error("the file is cut short");
		}
		std::memcpy(r_data, bytes.data() + position, count);
		if (position < header.size()) {
			const size_t replaced = std::min<size_t>(count, header.size() - position);
			std::memcpy(r_data, header.data() + position, replaced);
		}
		position += count;
		return position < bytes.size();
	}
	uint64_t tellg() override { return position; }
	void seekg(uint64_t p_position) override { position = p_position; }
	void clear() override {}

private:
	std::span<const uint8_t> bytes;
	std::vector<uint8_t> header;
	uint64_t position = 0;
};

/// Makes a slice whose first pixel is the data window's corner.
Imf::Slice make_slice(float *p_values, const Imath::V2i &p_corner, uint32_t p_width) {
	// Computed as integers, because for a window far from (0, 0) the base address is outside of
	// the array.
	const intptr_t row = static_cast<intptr_t>(p_width);
	const intptr_t offset = p_corner.x + p_corner.y * row;
	const uintptr_t origin =
			reinterpret_cast<uintptr_t>(p_values) - static_cast<uintptr_t>(offset) * sizeof(float);
	return Imf::Slice(Imf::FLOAT, reinterpret_cast<char *>(origin), sizeof(float),
			static_cast<size_t>(row) * sizeof(float));
}

void check_channel(
		const Imf::ChannelList &p_channels, const char *p_channel, const std::string &p_name) {
	const Imf::Channel *channel = p_channels.findChannel(p_channel);
	if (channel == nullptr) {
		fail("Mask ", p_name, ": the channel \"", p_channel,
				"\" is missing; a mask has the channels ", VISIBILITY_CHANNEL, " and ",
				RECEIVER_CHANNEL, ". Write it with `gnomon visibility`.");
	}
	if (channel->xSampling != 1 || channel->ySampling != 1) {
		fail("Mask ", p_name, ": the channel \"", p_channel, "\" is stored at a lower resolution, ",
				channel->xSampling, " x ", channel->ySampling, ", must be 1 x 1.");
	}
}

void check_size(int64_t p_width, int64_t p_height, const std::string &p_name) {
	const int64_t limit = MAX_IMAGE_SIZE_PX;
	if (p_width < 1 || p_height < 1 || p_width > limit || p_height > limit) {
		fail("Mask ", p_name, ": the size is ", p_width, " x ", p_height, ", must be 1..", limit,
				" on each side.");
	}
}

MaskImage decode(std::span<const uint8_t> p_bytes, const std::string &p_name) {
	MemoryInput stream(p_bytes, make_safe_exr_header(p_bytes, p_name));
	Imf::InputFile file(stream, /*numThreads=*/0);
	check_channel(file.header().channels(), VISIBILITY_CHANNEL, p_name);
	check_channel(file.header().channels(), RECEIVER_CHANNEL, p_name);
	const Imath::Box2i window = file.header().dataWindow();
	const int64_t width = int64_t(window.max.x) - window.min.x + 1;
	const int64_t height = int64_t(window.max.y) - window.min.y + 1;
	check_size(width, height, p_name);
	MaskImage image;
	image.size_px = glm::uvec2(width, height);
	if (image.get_pixel_count() / MAX_PIXELS_PER_BYTE > p_bytes.size()) {
		fail("Mask ", p_name, ": ", p_bytes.size(), " bytes cannot hold ", width, " x ", height,
				" pixels. The file is damaged: write it again.");
	}
	image.visibility.resize(image.get_pixel_count());
	image.receiver.resize(image.get_pixel_count());
	Imf::FrameBuffer buffer;
	buffer.insert(
			VISIBILITY_CHANNEL, make_slice(image.visibility.data(), window.min, image.size_px.x));
	buffer.insert(RECEIVER_CHANNEL, make_slice(image.receiver.data(), window.min, image.size_px.x));
	file.setFrameBuffer(buffer);
	file.readPixels(window.min.y, window.max.y);
	return image;
}

} // namespace

std::vector<uint8_t> encode_mask_exr(const MaskImage &p_image, const std::string &p_name) {
	check_size(p_image.size_px.x, p_image.size_px.y, p_name);
	GNOMON_ASSERT(p_image.visibility.size() == p_image.get_pixel_count() &&
					p_image.receiver.size() == p_image.get_pixel_count(),
			p_name, ": ", p_image.visibility.size(), " and ", p_image.receiver.size(),
			" values for ", p_image.get_pixel_count(), " pixels");
	Imf::StdOSStream stream;
	try {
		const int width = static_cast<int>(p_image.size_px.x);
		const int height = static_cast<int>(p_image.size_px.y);
		Imf::Header header(width, height);
		header.compression() = Imf::ZIP_COMPRESSION;
		header.channels().insert(VISIBILITY_CHANNEL, Imf::Channel(Imf::FLOAT));
		header.channels().insert(RECEIVER_CHANNEL, Imf::Channel(Imf::FLOAT));
		// OpenEXR has no const frame buffer; writing does not change the pixels.
		Imf::FrameBuffer buffer;
		buffer.insert(VISIBILITY_CHANNEL,
				make_slice(const_cast<float *>(p_image.visibility.data()), { 0, 0 },
						p_image.size_px.x));
		buffer.insert(RECEIVER_CHANNEL,
				make_slice(
						const_cast<float *>(p_image.receiver.data()), { 0, 0 }, p_image.size_px.x));
		Imf::OutputFile file(stream, header, /*numThreads=*/0);
		file.setFrameBuffer(buffer);
		file.writePixels(height);
	} catch (const std::exception &exception) {
		fail("Mask ", p_name, ": cannot be encoded: ", exception.what());
	}
	const std::string bytes = stream.str();
	return { bytes.begin(), bytes.end() };
}

MaskImage decode_mask_exr(std::span<const uint8_t> p_bytes, const std::string &p_name) {
	// OpenEXR compares headers with these limits before it allocates memory for a line.
	static std::once_flag once;
	std::call_once(once, [] {
		Imf::Header::setMaxImageSize(MAX_IMAGE_SIZE_PX, MAX_IMAGE_SIZE_PX);
		Imf::Header::setMaxTileSize(MAX_IMAGE_SIZE_PX, MAX_IMAGE_SIZE_PX);
	});
	try {
		return decode(p_bytes, p_name);
	} catch (const Error &) {
		throw;
	} catch (const std::exception &exception) {
		fail("Mask ", p_name, ": not a readable OpenEXR file of at most ", MAX_IMAGE_SIZE_PX, " x ",
				MAX_IMAGE_SIZE_PX, " pixels: ", exception.what(), ". Write it again.");
	}
}

void save_mask_exr(const std::filesystem::path &p_path, const MaskImage &p_image) {
	save_file_atomically(p_path, encode_mask_exr(p_image, p_path.string()));
}

MaskImage load_mask_exr(const std::filesystem::path &p_path) {
	return decode_mask_exr(load_file(p_path, FILE_LIMIT_BYTES), p_path.string());
}

} // namespace gnomon
