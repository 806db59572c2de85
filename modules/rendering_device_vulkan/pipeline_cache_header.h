#pragma once

#include "modules/rendering_device_vulkan/vulkan_handles.h"

#include <cstdint>
#include <span>

namespace gnomon {

/// Returns whether the bytes begin with the header that this device's driver writes. Drivers must
/// reject foreign data themselves, but some have crashed on it instead.
bool is_pipeline_cache_of(
		std::span<const uint8_t> p_bytes, const VkPhysicalDeviceProperties &p_device);

} // namespace gnomon
