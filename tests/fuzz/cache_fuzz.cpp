// fuzz: modules=core sources=modules/rendering_device_vulkan/pipeline_cache_header.cpp
// Parses arbitrary bytes as a cache file (build_cache_entry), and as a driver's pipeline cache
// data.
#include "modules/core/files.h"
#include "modules/rendering_device_vulkan/pipeline_cache_header.h"

#include "tests/fuzz/fuzz_target.h"

#include <algorithm>

using namespace gnomon;

namespace {

/// The device whose pipeline caches the corpus contains.
const VkPhysicalDeviceProperties DEVICE_PROPERTIES = { .vendorID = 0x10005, // Mesa
	.pipelineCacheUUID = { 'G', 'N', 'O', 'M', 'O', 'N' } };

/// Checks that data of DEVICE_PROPERTIES is refused for devices that differ from it in one bit.
void check_other_devices(std::span<const uint8_t> p_bytes) {
	for (size_t bit = 0; bit < 8 * std::size(DEVICE_PROPERTIES.pipelineCacheUUID); ++bit) {
		VkPhysicalDeviceProperties other = DEVICE_PROPERTIES;
		other.pipelineCacheUUID[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
		GNOMON_ASSERT(!is_pipeline_cache_of(p_bytes, other), "bit ", bit, " of the UUID");
	}
	for (uint32_t bit = 0; bit < 32; ++bit) {
		VkPhysicalDeviceProperties other = DEVICE_PROPERTIES;
		other.vendorID ^= 1u << bit;
		GNOMON_ASSERT(!is_pipeline_cache_of(p_bytes, other), "bit ", bit, " of the vendor");
		other = DEVICE_PROPERTIES;
		other.deviceID ^= 1u << bit;
		GNOMON_ASSERT(!is_pipeline_cache_of(p_bytes, other), "bit ", bit, " of the device");
	}
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *p_data, size_t p_size) {
	return run_reader([&] {
		const std::span<const uint8_t> bytes(p_data, p_size);
		const std::vector<uint8_t> entry = build_cache_entry(bytes);
		const auto payload = parse_cache_entry(entry);
		GNOMON_ASSERT(
				payload && std::ranges::equal(*payload, bytes), "other bytes than were stored");
		if (const auto stored = parse_cache_entry(bytes)) {
			GNOMON_ASSERT(std::ranges::equal(build_cache_entry(*stored), bytes),
					"accepted an entry that build_cache_entry does not build");
		}
		if (is_pipeline_cache_of(bytes, DEVICE_PROPERTIES)) {
			check_other_devices(bytes);
		}
	});
}
