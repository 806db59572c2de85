#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/tests/temporary_folder.h"
#include "modules/masks/mask_image.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <limits>
#include <random>

using namespace gnomon;
namespace fs = std::filesystem;

namespace {

MaskImage make_image(uint32_t p_width, uint32_t p_height) {
	MaskImage image;
	image.size_px = glm::uvec2(p_width, p_height);
	std::mt19937 random(p_width * 1000 + p_height);
	std::uniform_real_distribution<float> value(0, 1);
	for (size_t i = 0; i < image.get_pixel_count(); ++i) {
		image.receiver.push_back(i % 5 == 0 ? 0.0f : 1.0f);
		image.visibility.push_back(i % 5 == 0 ? 0.0f : value(random));
	}
	return image;
}

/// Writes channels of zeros with a data window that starts at p_corner.
void write_exr(const fs::path &p_path, const std::vector<std::string> &p_channels,
		Imf::PixelType p_type, const Imath::V2i &p_corner, int p_size_px,
		Imf::Compression p_compression) {
	const Imath::Box2i window(p_corner, p_corner + Imath::V2i(p_size_px - 1));
	Imf::Header header(window, window);
	header.compression() = p_compression;
	std::vector<uint32_t> zeros(static_cast<size_t>(p_size_px), 0);
	Imf::FrameBuffer buffer;
	for (const std::string &channel : p_channels) {
		header.channels().insert(channel, Imf::Channel(p_type));
		// Stride 0: all rows read the same zeros, so that the window's height does not matter.
		const size_t stride = p_type == Imf::HALF ? 2 : 4;
		const uintptr_t base = reinterpret_cast<uintptr_t>(zeros.data()) -
				static_cast<uintptr_t>(static_cast<intptr_t>(p_corner.x)) * stride;
		buffer.insert(channel, Imf::Slice(p_type, reinterpret_cast<char *>(base), stride, 0));
	}
	Imf::OutputFile file(p_path.string().c_str(), header, /*numThreads=*/0);
	file.setFrameBuffer(buffer);
	file.writePixels(p_size_px);
}

std::string get_error(const fs::path &p_path) {
	try {
		load_mask_exr(p_path);
	} catch (const Error &error) {
		return error.what();
	}
	return "";
}

} // namespace

TEST_CASE("[MaskImage] a saved mask loads bit-identical, odd sizes and denormals too") {
	TemporaryFolder folder;
	for (const glm::uvec2 &size : { glm::uvec2(1, 1), glm::uvec2(7, 33), glm::uvec2(128, 17) }) {
		MaskImage image = make_image(size.x, size.y);
		image.visibility[0] = std::numeric_limits<float>::denorm_min();
		save_mask_exr(folder.path / "mask.exr", image);
		const MaskImage loaded = load_mask_exr(folder.path / "mask.exr");
		CHECK(loaded.size_px == image.size_px);
		CHECK(loaded.visibility == image.visibility);
		CHECK(loaded.receiver == image.receiver);
	}
	CHECK(std::distance(fs::directory_iterator(folder.path), {}) == 1); // no temporary files
}

TEST_CASE("[MaskImage] images without pixels, unwritable paths and missing files are errors") {
	TemporaryFolder folder;
	CHECK_THROWS_AS(save_mask_exr(folder.path / "mask.exr", MaskImage()), Error);
	CHECK_THROWS_AS(save_mask_exr(folder.path / "none" / "mask.exr", make_image(2, 2)), Error);
	CHECK_THROWS_AS(load_mask_exr(folder.path / "none.exr"), Error);
	CHECK(fs::is_empty(folder.path));
}

TEST_CASE("[MaskImage] other channels, half floats, offsets and compressions are read") {
	TemporaryFolder folder;
	const fs::path path = folder.path / "other.exr";
	for (const Imf::Compression compression : { Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION,
				 Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION }) {
		for (const Imf::PixelType type : { Imf::FLOAT, Imf::HALF }) {
			write_exr(path, { "A", "R", "Y", "receiver" }, type, { -500, 100000 }, 40, compression);
			const MaskImage image = load_mask_exr(path);
			CHECK(image.size_px == glm::uvec2(40, 40));
			CHECK(std::count(image.visibility.begin(), image.visibility.end(), 0.0f) == 1600);
		}
	}
}

TEST_CASE("[MaskImage] the error of a missing channel names it") {
	TemporaryFolder folder;
	const fs::path path = folder.path / "half.exr";
	write_exr(path, { "Y" }, Imf::FLOAT, { 0, 0 }, 4, Imf::ZIP_COMPRESSION);
	CHECK(get_error(path).find("\"receiver\" is missing") != std::string::npos);
	CHECK(get_error(path).find("half.exr") != std::string::npos);
	write_exr(path, { "receiver", "R" }, Imf::FLOAT, { 0, 0 }, 4, Imf::ZIP_COMPRESSION);
	CHECK(get_error(path).find("\"Y\" is missing") != std::string::npos);
}

TEST_CASE("[MaskImage] a header with a size that is too large, 0 or negative is refused") {
	TemporaryFolder folder;
	std::vector<uint8_t> bytes = encode_mask_exr(make_image(16, 16), "small");
	// Layout of dataWindow: name, type, size, then four int32: xMin yMin xMax yMax.
	const std::string key = "dataWindow";
	const auto found = std::search(bytes.begin(), bytes.end(), key.begin(), key.end());
	REQUIRE(found != bytes.end());
	const size_t maximum = static_cast<size_t>(found - bytes.begin()) + 11 + 6 + 4 + 8;
	REQUIRE(bytes[maximum] == 15);
	const auto try_size = [&](int32_t p_maximum) {
		for (int axis = 0; axis < 2; ++axis) {
			for (int byte = 0; byte < 4; ++byte) {
				bytes[maximum + 4 * axis + byte] = static_cast<uint8_t>(p_maximum >> (8 * byte));
			}
		}
		CHECK_THROWS_AS(decode_mask_exr(bytes, "hostile"), Error);
	};
	for (const int32_t size : { 16383, 16384, 1000000, 0x3fffffff, 0x7fffffff, -1, -5 }) {
		CAPTURE(size);
		try_size(size);
	}
}

TEST_CASE("[MaskImage] multi-part files, deep pixels and attributes longer than a file fail") {
	const std::vector<uint8_t> bytes = encode_mask_exr(make_image(16, 16), "whole");
	for (const uint8_t flag : { 0x08, 0x10 }) { // deep pixels, several parts
		std::vector<uint8_t> changed = bytes;
		changed[5] |= flag;
		CHECK_THROWS_AS(decode_mask_exr(changed, "parts"), Error);
	}
	// The highest byte of the first attribute's length, which follows 8 bytes of magic and version,
	// the name "channels" and the type "chlist".
	std::vector<uint8_t> longer = bytes;
	longer[8 + 9 + 7 + 3] = 0x7f;
	CHECK_THROWS_WITH_AS(decode_mask_exr(longer, "longer"), doctest::Contains("cut short"), Error);
}

TEST_CASE("[MaskImage] a file truncated anywhere is an error") {
	const std::vector<uint8_t> bytes = encode_mask_exr(make_image(40, 40), "whole");
	// Every byte of the header, which is shorter than 600, then samples of the pixels' data.
	for (size_t size = 0; size < bytes.size(); size += size < 600 ? 1 : 37) {
		CAPTURE(size);
		CHECK_THROWS_AS(decode_mask_exr(std::span(bytes).first(size), "cut"), Error);
	}
	CHECK_THROWS_AS(decode_mask_exr(std::span(bytes).first(bytes.size() - 1), "cut"), Error);
	CHECK_NOTHROW(decode_mask_exr(bytes, "whole"));
}

TEST_CASE("[MaskImage] damaged files give a consistent image or an error, never a crash") {
	const std::vector<uint8_t> bytes = encode_mask_exr(make_image(24, 24), "whole");
	std::mt19937 random(3);
	for (int i = 0; i < 500; ++i) {
		std::vector<uint8_t> damaged = bytes;
		for (int flip = 0; flip <= i % 4; ++flip) {
			// Two thirds of the files are damaged in their first 400 bytes only: in the header,
			// which has the lengths and types, or right after it.
			const size_t range = i % 3 == 0 ? damaged.size() : 400;
			damaged[random() % range] = static_cast<uint8_t>(random());
		}
		try {
			const MaskImage image = decode_mask_exr(damaged, "damaged");
			CHECK(image.visibility.size() == image.get_pixel_count());
		} catch (const Error &) {
		}
	}
}

TEST_CASE("[MaskImage] attributes that a mask does not need are skipped, even invalid ones") {
	const MaskImage image = make_image(5, 3);
	std::vector<uint8_t> bytes = encode_mask_exr(image, "whole");
	// The header is followed by the 8-byte offset of the only block, which begins right after it.
	size_t table = 8;
	uint64_t block = 0;
	while (block != table + sizeof(block)) {
		++table;
		REQUIRE(table + sizeof(block) < bytes.size());
		std::memcpy(&block, bytes.data() + table, sizeof(block));
	}
	// An attribute "x" of the type "preview" and 8 bytes: a width and a height, which OpenEXR would
	// refuse or allocate memory for.
	const std::string preview("x\0preview\0\x08\0\0\0\xff\xff\xff\x7f\xff\xff\0\0", 22);
	block += preview.size();
	std::memcpy(bytes.data() + table, &block, sizeof(block));
	bytes.insert(bytes.begin() + 8, preview.begin(), preview.end());
	CHECK(decode_mask_exr(bytes, "with preview").visibility == image.visibility);
}

TEST_CASE("[MaskImage] a channel list that is not as long as it states is refused") {
	std::vector<uint8_t> bytes = encode_mask_exr(make_image(16, 16), "whole");
	const size_t length = 8 + 9 + 7;		  // behind the names "channels" and "chlist"
	for (const int change : { -18, -1, 1 }) { // 18: bytes of the channel "Y"
		std::vector<uint8_t> changed = bytes;
		changed[length] = static_cast<uint8_t>(changed[length] + change);
		CHECK_THROWS_WITH_AS(decode_mask_exr(changed, "list"),
				doctest::Contains("not as long as it states"), Error);
	}
}
