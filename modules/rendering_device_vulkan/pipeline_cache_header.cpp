#include "modules/rendering_device_vulkan/pipeline_cache_header.h"

#include <cstring>

namespace gnomon {

namespace {

/// VkPipelineCacheHeaderVersionOne, little-endian; without Vulkan's headers, so that every bit of
/// the decision is tested without a device.
struct Header {
	uint32_t size_bytes = 0;
	uint32_t version = 0;
	uint32_t vendor_id = 0;
	uint32_t device_id = 0;
	std::array<uint8_t, 16> cache_uuid = {};
};
static_assert(sizeof(Header) == 32);
constexpr uint32_t VERSION_ONE = 1;

} // namespace

bool is_pipeline_cache_of(std::span<const uint8_t> p_bytes, const PipelineCacheMaker &p_maker) {
	Header header;
	if (p_bytes.size() < sizeof(header)) {
		return false;
	}
	std::memcpy(&header, p_bytes.data(), sizeof(header));
	// A later version may lengthen its header, but never beyond the bytes there are.
	return header.size_bytes >= sizeof(header) && header.size_bytes <= p_bytes.size() &&
			header.version == VERSION_ONE && header.vendor_id == p_maker.vendor_id &&
			header.device_id == p_maker.device_id && header.cache_uuid == p_maker.cache_uuid;
}

} // namespace gnomon
