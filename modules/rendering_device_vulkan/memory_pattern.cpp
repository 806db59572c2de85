#include "modules/rendering_device_vulkan/memory_pattern.h"

#include "modules/core/error.h"

#include <algorithm>
#include <cstring>

namespace gnomon {

namespace {

uint32_t next_word(MemoryPattern p_pattern, uint32_t &r_random) {
	switch (p_pattern) {
		case MemoryPattern::ONE:
			return 1;
		case MemoryPattern::DEADBEEF:
			return 0xdeadbeef;
		case MemoryPattern::NAN_FLOAT:
			return 0xffffffff;
		case MemoryPattern::RANDOM:
			break;
	}
	// Marsaglia 2003, "Xorshift RNGs", with the shifts 13, 17 and 5. The state must not be 0.
	r_random ^= r_random << 13;
	r_random ^= r_random >> 17;
	r_random ^= r_random << 5;
	return r_random;
}

} // namespace

std::optional<MemoryPattern> parse_memory_pattern(const std::string &p_written) {
	if (p_written.empty()) {
		return std::nullopt;
	}
	if (p_written == "1") {
		return MemoryPattern::ONE;
	}
	if (p_written == "deadbeef") {
		return MemoryPattern::DEADBEEF;
	}
	if (p_written == "nan") {
		return MemoryPattern::NAN_FLOAT;
	}
	if (p_written == "random") {
		return MemoryPattern::RANDOM;
	}
	fail("GNOMON_MEMORY_PATTERN is \"", p_written,
			"\", must be 1, deadbeef, nan or random. Change it, or unset it.");
}

void fill_memory(std::span<uint8_t> r_bytes, MemoryPattern p_pattern, uint32_t &r_random) {
	for (size_t offset = 0; offset < r_bytes.size(); offset += sizeof(uint32_t)) {
		const uint32_t word = next_word(p_pattern, r_random);
		std::memcpy(
				r_bytes.data() + offset, &word, std::min(sizeof(word), r_bytes.size() - offset));
	}
}

} // namespace gnomon
