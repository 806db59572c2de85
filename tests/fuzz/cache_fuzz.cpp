// fuzz: modules=core sources=modules/rendering_device_vulkan/pipeline_cache_header.cpp
// Any bytes as a file of the cache, and as the pipelines that a driver left there.
#include "modules/core/files.h"
#include "modules/rendering_device_vulkan/pipeline_cache_header.h"

#include "tests/fuzz/fuzz_target.h"

#include <algorithm>

using namespace gnomon;

namespace {

/// Of the device that this file's inputs are for.
const VkPhysicalDeviceProperties MAKER = { .vendorID = 0x10005,
	.pipelineCacheUUID = { 'G', 'N', 'O', 'M', 'O', 'N' } };

void check_foreign_makers(std::span<const uint8_t> p_bytes) {
	for (size_t bit = 0; bit < 8 * std::size(MAKER.pipelineCacheUUID); ++bit) {
		VkPhysicalDeviceProperties other = MAKER;
		other.pipelineCacheUUID[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
		GNOMON_ASSERT(!is_pipeline_cache_of(p_bytes, other), "bit ", bit, " of the UUID");
	}
	for (uint32_t bit = 0; bit < 32; ++bit) {
		VkPhysicalDeviceProperties other = MAKER;
		other.vendorID ^= 1u << bit;
		GNOMON_ASSERT(!is_pipeline_cache_of(p_bytes, other), "bit ", bit, " of the vendor");
		other = MAKER;
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
		GNOMON_ASSERT(payload && std::ranges::equal(*payload, bytes), "not what was stored");
		if (const auto stored = parse_cache_entry(bytes)) {
			GNOMON_ASSERT(std::ranges::equal(build_cache_entry(*stored), bytes),
					"an entry that is never written is accepted");
		}
		if (is_pipeline_cache_of(bytes, MAKER)) {
			check_foreign_makers(bytes);
		}
	});
}
