#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/tests/temporary_folder.h"
#include "modules/masks/mask_png.h"

#include "tests/png_pixels.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <limits>

using namespace gnomon;
namespace fs = std::filesystem;

namespace {

MaskImage make_test_mask() {
	MaskImage image;
	image.size_px = glm::uvec2(3, 2);
	image.visibility = { 0, 0.5f, 1, 0.25f, 0, 0.999f };
	image.receiver = { 1, 1, 1, 1, 0, 1 };
	return image;
}

std::vector<uint8_t> load_png(const fs::path &p_path, uint32_t p_channel_count) {
	const PngPixels pixels = load_png_pixels(p_path, 0);
	CHECK(pixels.size_px == glm::uvec2(3, 2));
	CHECK(pixels.channel_count == p_channel_count);
	return pixels.values;
}

} // namespace

TEST_CASE("[MaskPng] saved files have the computed pixels; bad paths and empty masks are errors") {
	const TemporaryFolder temporary;
	const fs::path &folder = temporary.path;
	MaskImage image = make_test_mask();
	image.visibility[4] = 0.7f; // not a receiver: black
	save_mask_png(folder / "mask.png", image);
	CHECK(load_png(folder / "mask.png", 1) == std::vector<uint8_t>{ 0, 128, 255, 64, 0, 255 });

	MaskImage result = make_test_mask();
	result.visibility[1] = 0.25f;
	save_error_png(folder / "error.png", make_test_mask(), result);
	CHECK(load_png(folder / "error.png", 3) == compute_error_pixels(make_test_mask(), result));
	CHECK_THROWS_AS(save_mask_png(folder / "none" / "mask.png", image), Error);
	CHECK_THROWS_AS(save_mask_png(folder / "empty.png", MaskImage()), Error);
	CHECK(std::distance(fs::directory_iterator(folder), {}) == 2); // mask.png and error.png
}

TEST_CASE("[MaskPng] errors are white at 0, blue when too dark, red when too light") {
	const MaskImage reference = make_test_mask();
	MaskImage result = reference;
	result.visibility = { 0, 0.25f, 0, 0.375f, 0, 0.999f };
	const std::vector<uint8_t> pixels = compute_error_pixels(reference, result);
	const std::vector<uint8_t> expected = {
		255,
		255,
		255, // no error
		0,
		0,
		255, // -0.25: full blue
		0,
		0,
		255, // -1: clamped to full blue
		255,
		128,
		128, // +0.125: half red
		96,
		96,
		96, // no receiver
		255,
		255,
		255,
	};
	CHECK(pixels == expected);
}

TEST_CASE("[MaskPng] values outside 0..1 are clamped, those not finite are errors") {
	MaskImage image = make_test_mask();
	image.visibility[0] = -3;
	image.visibility[1] = 7;
	CHECK(compute_mask_pixels(image)[0] == 0);
	CHECK(compute_mask_pixels(image)[1] == 255);
	image.visibility[1] = std::numeric_limits<float>::quiet_NaN();
	CHECK_THROWS_AS(compute_mask_pixels(image), Error);
	CHECK_THROWS_AS(compute_error_pixels(image, make_test_mask()), Error);
}
