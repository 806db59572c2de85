#pragma once

// The handle types alone. The window's owner includes this before its window library, so that both
// agree on VkInstance and VkSurfaceKHR; nothing else outside this module needs it.
#include <vulkan/vulkan_core.h>
