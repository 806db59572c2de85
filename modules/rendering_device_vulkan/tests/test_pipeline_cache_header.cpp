#include "modules/rendering_device_vulkan/pipeline_cache_header.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

using namespace gnomon;

namespace {

const VkPhysicalDeviceProperties MAKER = { .vendorID = 0x10005,
	.deviceID = 7,
	.pipelineCacheUUID = { 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15 } };

/// As the driver of MAKER writes it: a header of 32 bytes, then its own.
std::vector<uint8_t> make_cache() {
	const uint8_t numbers[] = { 32, 0, 0, 0, 1, 0, 0, 0, 5, 0, 1, 0, 7, 0, 0, 0 };
	std::vector<uint8_t> bytes(42, 0xAB);
	std::copy(std::begin(numbers), std::end(numbers), bytes.begin());
	std::copy(std::begin(MAKER.pipelineCacheUUID), std::end(MAKER.pipelineCacheUUID),
			bytes.begin() + sizeof(numbers));
	return bytes;
}

} // namespace

TEST_CASE("[PipelineCacheHeader] pipelines of the same driver are taken") {
	const std::vector<uint8_t> cache = make_cache();
	CHECK(is_pipeline_cache_of(cache, MAKER));
	CHECK(is_pipeline_cache_of(std::span(cache).first(32), MAKER));
}

TEST_CASE("[PipelineCacheHeader] a header that differs in any byte or is cut short is refused") {
	const std::vector<uint8_t> cache = make_cache();
	for (size_t index = 0; index < 32; ++index) {
		CAPTURE(index);
		std::vector<uint8_t> changed = cache;
		changed[index] ^= 0x80;
		CHECK_FALSE(is_pipeline_cache_of(changed, MAKER));
		CHECK_FALSE(is_pipeline_cache_of(std::span(cache).first(index), MAKER));
	}
}
