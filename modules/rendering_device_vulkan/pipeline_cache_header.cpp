#include "modules/rendering_device_vulkan/pipeline_cache_header.h"

#include <algorithm>
#include <cstring>

namespace gnomon {

bool is_pipeline_cache_of(
		std::span<const uint8_t> p_bytes, const VkPhysicalDeviceProperties &p_device) {
	VkPipelineCacheHeaderVersionOne expected = { .headerVersion =
														 VK_PIPELINE_CACHE_HEADER_VERSION_ONE,
		.vendorID = p_device.vendorID,
		.deviceID = p_device.deviceID };
	if (p_bytes.size() < sizeof(expected)) {
		return false;
	}
	std::ranges::copy(p_device.pipelineCacheUUID, expected.pipelineCacheUUID);
	// A later driver may write a longer header, but it must fit into the data.
	std::memcpy(&expected.headerSize, p_bytes.data(), sizeof(expected.headerSize));
	return expected.headerSize >= sizeof(expected) && expected.headerSize <= p_bytes.size() &&
			std::memcmp(p_bytes.data(), &expected, sizeof(expected)) == 0;
}

} // namespace gnomon
