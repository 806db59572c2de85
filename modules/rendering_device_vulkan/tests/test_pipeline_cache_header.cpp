#include "modules/rendering_device_vulkan/pipeline_cache_header.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

using namespace gnomon;

namespace {

// Of VkPipelineCacheHeaderVersionOne.
const size_t HEADER_BYTES = 32;
const VkPhysicalDeviceProperties DEVICE_PROPERTIES = { .vendorID = 0x10005,
	.deviceID = 7,
	.pipelineCacheUUID = { 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15 } };

/// Makes a cache as the driver of this device writes it: the header, then 10 bytes of other data.
std::vector<uint8_t> make_cache() {
	// Little-endian: header size, header version (1), vendor, device.
	const uint8_t numbers[] = { 32, 0, 0, 0, 1, 0, 0, 0, 5, 0, 1, 0, 7, 0, 0, 0 };
	std::vector<uint8_t> bytes(HEADER_BYTES + 10, 0xAB);
	std::copy(std::begin(numbers), std::end(numbers), bytes.begin());
	std::copy(std::begin(DEVICE_PROPERTIES.pipelineCacheUUID),
			std::end(DEVICE_PROPERTIES.pipelineCacheUUID), bytes.begin() + sizeof(numbers));
	return bytes;
}

} // namespace

TEST_CASE("[PipelineCacheHeader] a cache of the same driver is accepted") {
	const std::vector<uint8_t> cache = make_cache();
	CHECK(is_pipeline_cache_of(cache, DEVICE_PROPERTIES));
	CHECK(is_pipeline_cache_of(std::span(cache).first(HEADER_BYTES), DEVICE_PROPERTIES));
}

TEST_CASE("[PipelineCacheHeader] a header that differs in any byte or is cut short is refused") {
	const std::vector<uint8_t> cache = make_cache();
	for (size_t index = 0; index < HEADER_BYTES; ++index) {
		CAPTURE(index);
		std::vector<uint8_t> changed = cache;
		changed[index] ^= 0x80;
		CHECK_FALSE(is_pipeline_cache_of(changed, DEVICE_PROPERTIES));
		CHECK_FALSE(is_pipeline_cache_of(std::span(cache).first(index), DEVICE_PROPERTIES));
	}
}
