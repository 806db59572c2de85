#include "modules/gltf_scene/image_decoder.h"

#include "modules/core/error.h"

#include <png.h>
#include <turbojpeg.h>

#include <csetjmp>
#include <cstring>
#include <string_view>

namespace gnomon {

namespace {

const uint8_t PNG_SIGNATURE[] = { 0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n' };
const uint8_t JPEG_SIGNATURE[] = { 0xff, 0xd8, 0xff };
const char EXPORT_IMAGE_AGAIN[] = "Export the image again.";
const png_byte ANIMATION_CHUNK[] = "acTL"; // APNG 1.0: marks an animated image

/// Describes an image format that is not supported, for the error message.
struct UnsupportedFormat {
	std::string_view name;
	size_t offset_bytes; // of the signature in the file
	std::string_view signature;
};
const UnsupportedFormat UNSUPPORTED_FORMATS[] = {
	{ "a GIF", 0, "GIF8" },
	{ "a WebP", 8, "WEBP" },
	{ "a KTX", 1, "KTX " },
	{ "a DDS", 0, "DDS " },
	{ "an AVIF", 4, "ftypavif" },
};

template <size_t COUNT>
bool begins_with(std::span<const uint8_t> p_bytes, const uint8_t (&p_signature)[COUNT]) {
	return p_bytes.size() >= COUNT && std::memcmp(p_bytes.data(), p_signature, COUNT) == 0;
}

void check_size(uint64_t p_width_px, uint64_t p_height_px) {
	if (p_width_px == 0 || p_height_px == 0 || p_width_px > MAX_IMAGE_SIZE_PX ||
			p_height_px > MAX_IMAGE_SIZE_PX || p_width_px * p_height_px > MAX_IMAGE_TEXELS) {
		fail("has ", p_width_px, " x ", p_height_px, " pixels, must have 1..", MAX_IMAGE_SIZE_PX,
				" on each side and at most ", MAX_IMAGE_TEXELS, " in all. Make it smaller.");
	}
}

/// Wraps libpng and holds the state for its callbacks. A failed libpng call returns by longjmp,
/// which must not skip a destructor, so the methods that call libpng own no memory themselves.
struct PngReader {
	std::span<const uint8_t> rest; // bytes not read yet
	char problem[128] = "";
	png_structp png = nullptr;
	png_infop info = nullptr;

	explicit PngReader(std::span<const uint8_t> p_bytes) : rest(p_bytes) {
		png = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, handle_error, ignore_warning);
		info = png ? png_create_info_struct(png) : nullptr;
		if (!info) {
			png_destroy_read_struct(&png, nullptr, nullptr);
			throw std::bad_alloc();
		}
		png_set_read_fn(png, this, read);
	}
	~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
	PngReader(const PngReader &) = delete;
	PngReader &operator=(const PngReader &) = delete;

	/// Returns false on failure; `problem` then has libpng's message.
	bool read_header() {
		if (setjmp(png_jmpbuf(png))) {
			return false;
		}
		// check_size checks the size later, with a message that gives the limits.
		png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
		// libpng does not know the chunk and would drop it; is_animated looks for it.
		png_set_keep_unknown_chunks(
				png, PNG_HANDLE_CHUNK_ALWAYS, ANIMATION_CHUNK, /*num_chunks=*/1);
		png_read_info(png, info);
		return true;
	}
	bool is_animated() {
		png_unknown_chunkp chunks = nullptr;
		return png_get_unknown_chunks(png, info, &chunks) > 0;
	}
	/// Decodes to RGBA with 8 bits per channel. p_rows: a pointer to each row. Returns false on
	/// failure, as read_header.
	bool read_rows(uint8_t *const *p_rows) {
		if (setjmp(png_jmpbuf(png))) {
			return false;
		}
		png_set_expand(png);
		png_set_strip_16(png);
		png_set_gray_to_rgb(png);
		png_set_add_alpha(png, 0xff, PNG_FILLER_AFTER);
		png_read_image(png, const_cast<png_bytepp>(p_rows));
		return true;
	}

private:
	static void read(png_structp p_png, png_bytep r_bytes, size_t p_count) {
		PngReader &reader = *static_cast<PngReader *>(png_get_io_ptr(p_png));
		if (p_count > reader.rest.size()) {
			png_error(p_png, "it ends too early");
		}
		std::memcpy(r_bytes, reader.rest.data(), p_count);
		reader.rest = reader.rest.subspan(p_count);
	}
	[[noreturn]] static void handle_error(png_structp p_png, png_const_charp p_problem) {
		PngReader &reader = *static_cast<PngReader *>(png_get_error_ptr(p_png));
		std::strncpy(reader.problem, p_problem, sizeof(reader.problem) - 1);
		png_longjmp(p_png, 1);
	}
	static void ignore_warning(png_structp, png_const_charp) {}
};

std::shared_ptr<const Image> decode_png(
		std::span<const uint8_t> p_bytes, std::string p_name, std::string &r_warning) {
	PngReader reader(p_bytes);
	if (!reader.read_header()) {
		fail("is a PNG image that cannot be read: ", reader.problem, ". ", EXPORT_IMAGE_AGAIN);
	}
	const glm::uvec2 size_px(png_get_image_width(reader.png, reader.info),
			png_get_image_height(reader.png, reader.info));
	check_size(size_px.x, size_px.y);
	std::vector<uint8_t> texels(size_t(size_px.x) * size_px.y * 4);
	std::vector<uint8_t *> rows;
	for (size_t y = 0; y < size_px.y; ++y) {
		rows.push_back(texels.data() + y * size_px.x * 4);
	}
	if (!reader.read_rows(rows.data())) {
		fail("is a PNG image that cannot be read: ", reader.problem, ". ", EXPORT_IMAGE_AGAIN);
	}
	if (reader.is_animated()) {
		r_warning = "is an animated PNG image, of which the first frame is shown. Export it as one "
					"image.";
	}
	return make_image(std::move(p_name), size_px, std::move(texels));
}

std::shared_ptr<const Image> decode_jpeg(
		std::span<const uint8_t> p_bytes, std::string p_name, std::string &r_warning) {
	struct Decoder {
		tjhandle handle = tjInitDecompress();
		Decoder() {
			if (!handle) {
				throw std::bad_alloc();
			}
		}
		~Decoder() { tjDestroy(handle); }
	} decoder;
	const auto reject = [&] {
		fail("is a JPEG image that cannot be read: ", tjGetErrorStr2(decoder.handle), ". ",
				EXPORT_IMAGE_AGAIN);
	};
	int width_px = 0, height_px = 0, subsampling = 0, color_space = 0;
	if (tjDecompressHeader3(decoder.handle, p_bytes.data(), p_bytes.size(), &width_px, &height_px,
				&subsampling, &color_space) != 0 ||
			width_px == 0) {
		reject();
	}
	if (color_space == TJCS_CMYK || color_space == TJCS_YCCK) {
		fail("is a JPEG image with CMYK colours, must have RGB colours. ", EXPORT_IMAGE_AGAIN);
	}
	check_size(uint64_t(width_px), uint64_t(height_px));
	const glm::uvec2 size_px(width_px, height_px);
	std::vector<uint8_t> texels(size_t(size_px.x) * size_px.y * 4);
	// TJFLAG_LIMITSCANS rejects progressive files with very many scans, which would be slow.
	if (tjDecompress2(decoder.handle, p_bytes.data(), p_bytes.size(), texels.data(), width_px,
				/*pitch=*/0, height_px, TJPF_RGBA, TJFLAG_LIMITSCANS) != 0) {
		if (tjGetErrorCode(decoder.handle) != TJERR_WARNING) {
			reject();
		}
		r_warning = text("is a damaged JPEG image, of which a part is shown: ",
				tjGetErrorStr2(decoder.handle), ". ", EXPORT_IMAGE_AGAIN);
	}
	return make_image(std::move(p_name), size_px, std::move(texels));
}

} // namespace

std::shared_ptr<const Image> decode_image(
		std::span<const uint8_t> p_bytes, std::string p_name, std::string &r_warning) {
	if (begins_with(p_bytes, PNG_SIGNATURE)) {
		return decode_png(p_bytes, std::move(p_name), r_warning);
	}
	if (begins_with(p_bytes, JPEG_SIGNATURE)) {
		return decode_jpeg(p_bytes, std::move(p_name), r_warning);
	}
	const std::string_view bytes(reinterpret_cast<const char *>(p_bytes.data()), p_bytes.size());
	for (const UnsupportedFormat &format : UNSUPPORTED_FORMATS) {
		if (bytes.size() > format.offset_bytes &&
				bytes.substr(format.offset_bytes).starts_with(format.signature)) {
			fail("is ", format.name, " image, must be PNG or JPEG. Convert it to one of them.");
		}
	}
	fail("is ", p_bytes.empty() ? "empty" : "no image", ", must be PNG or JPEG. ",
			EXPORT_IMAGE_AGAIN);
}

} // namespace gnomon
