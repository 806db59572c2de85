// fuzz: modules=core sources=modules/shadow_reference/reference_entry.cpp
// Parses arbitrary bytes as a cached reference. The first nine bytes are the request: the number of
// pixels, and whether there must be colours.
#include "modules/shadow_reference/reference_entry.h"

#include "tests/fuzz/fuzz_target.h"

#include <algorithm>
#include <cstring>

using namespace gnomon;

namespace {

const uint64_t FUZZ_KEY = 0x676E6F6D6F6E2121; // any; this is "gnomon!!" in ASCII

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *p_data, size_t p_size) {
	return run_reader([&] {
		uint64_t pixel_count = 0;
		if (p_size <= sizeof(pixel_count)) {
			return;
		}
		std::memcpy(&pixel_count, p_data, sizeof(pixel_count));
		const bool is_colored = (p_data[sizeof(pixel_count)] & 1) != 0;
		const auto bytes = std::span(p_data, p_size).subspan(sizeof(pixel_count) + 1);
		const auto reference = parse_reference_entry(bytes, FUZZ_KEY, pixel_count, is_colored);
		if (!reference) {
			return;
		}
		GNOMON_ASSERT(reference->visibility.size() == pixel_count, reference->visibility.size(),
				" values");
		GNOMON_ASSERT(reference->colors.size() == (is_colored ? pixel_count : 0), "colours");
		const std::vector<uint8_t> again = build_reference_entry(FUZZ_KEY, *reference);
		constexpr size_t PADDING_BYTES = 4; // at the end of the header, never read
		constexpr size_t HEADER_BYTES = 32; // of EntryHeader, padding included
		GNOMON_ASSERT(again.size() == bytes.size() &&
						std::equal(again.begin(), again.begin() + HEADER_BYTES - PADDING_BYTES,
								bytes.begin()) &&
						std::equal(again.begin() + HEADER_BYTES, again.end(),
								bytes.begin() + HEADER_BYTES),
				"rebuilding the entry gives other bytes");
	});
}
