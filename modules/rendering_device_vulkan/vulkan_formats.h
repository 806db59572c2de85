#pragma once

#include "modules/rendering_device/resource_types.h"
#include "modules/rendering_device_vulkan/vulkan_handles.h"

namespace gnomon {

// Vulkan's equivalents of formats and usages.
VkFormat get_vulkan_format(Format p_format);
VkImageAspectFlags get_aspect(Format p_format);
VkImageUsageFlags get_vulkan_usage(TextureUsage p_usage);
VkBufferUsageFlags get_vulkan_usage(BufferUsage p_usage);
/// Returns an attribute's format: floats and uints by component count, other formats unchanged.
VkFormat get_attribute_format(const VertexAttribute &p_attribute);

} // namespace gnomon
