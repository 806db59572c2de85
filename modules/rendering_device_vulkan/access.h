#pragma once

#include "modules/rendering_device/resource_types.h"
#include "modules/rendering_device_vulkan/vulkan_handles.h"

namespace gnomon {

/// Returns the write flags of an access, which a barrier must make available.
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
/// Returns the image layout for this format: a depth-stencil attachment has layouts of its own.
VkImageLayout get_layout_for_format(VkImageLayout p_layout, Format p_format);

} // namespace gnomon
