// fuzz: modules=masks
// Decodes arbitrary bytes as an OpenEXR mask. A decoded mask must survive encoding and decoding.
#include "modules/masks/mask_image.h"

#include "tests/fuzz/fuzz_target.h"

#include <cstring>

using namespace gnomon;

namespace {

/// Larger masks are not encoded again: that is slow and tests nothing more.
constexpr size_t MAX_WRITTEN_PIXELS = 1 << 16;

bool is_same(const std::vector<float> &p_first, const std::vector<float> &p_second) {
	// Compares bytes, because NaN does not equal itself.
	return p_first.size() == p_second.size() &&
			std::memcmp(p_first.data(), p_second.data(), p_first.size() * sizeof(float)) == 0;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *p_data, size_t p_size) {
	return run_reader([&] {
		const MaskImage image = decode_mask_exr({ p_data, p_size }, "fuzzed");
		GNOMON_ASSERT(image.visibility.size() == image.get_pixel_count() &&
						image.receiver.size() == image.get_pixel_count(),
				image.visibility.size(), " values");
		if (image.get_pixel_count() <= MAX_WRITTEN_PIXELS) {
			const MaskImage again = decode_mask_exr(encode_mask_exr(image, "written"), "written");
			GNOMON_ASSERT(is_same(again.visibility, image.visibility) &&
							is_same(again.receiver, image.receiver),
					"another mask came back");
		}
	});
}
