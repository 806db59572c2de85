#pragma once

#include "modules/rendering_device/resource_types.h"
#include "modules/rendering_device_vulkan/vulkan_handles.h"

namespace gnomon {

/// The part of an access that must be made available to later ones: its writes.
VkAccessFlags2 get_write_access(Access p_access);

/// Execution and memory dependency of one Barrier; layouts only matter to textures.
struct Dependency {
	VkPipelineStageFlags2 source_stages = 0;
	VkAccessFlags2 source_access = 0;
	VkPipelineStageFlags2 target_stages = 0;
	VkAccessFlags2 target_access = 0;
	VkImageLayout old_layout = VK_IMAGE_LAYOUT_UNDEFINED;
	VkImageLayout new_layout = VK_IMAGE_LAYOUT_UNDEFINED;
	bool is_needed = true; // false: the accesses need no barrier between them
};
Dependency compute_dependency(const Barrier &p_barrier);
/// The layout of an access, for this format: an attachment with stencil has layouts of its own.
VkImageLayout get_layout(VkImageLayout p_layout, Format p_format);

} // namespace gnomon
