#include "modules/rendering_device_vulkan/pipeline_cache_header.h"

#include <algorithm>
#include <cstring>

namespace gnomon {

bool is_pipeline_cache_of(
		std::span<const uint8_t> p_bytes, const VkPhysicalDeviceProperties &p_device) {
	VkPipelineCacheHeaderVersionOne header;
	if (p_bytes.size() < sizeof(header)) {
		return false;
	}
	std::memcpy(&header, p_bytes.data(), sizeof(header));
	// A later version may lengthen its header, but never beyond the bytes there are.
	return header.headerSize >= sizeof(header) && header.headerSize <= p_bytes.size() &&
			header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE &&
			header.vendorID == p_device.vendorID && header.deviceID == p_device.deviceID &&
			std::ranges::equal(header.pipelineCacheUUID, p_device.pipelineCacheUUID);
}

} // namespace gnomon
