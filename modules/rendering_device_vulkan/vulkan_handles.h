#pragma once

// Vulkan without the headers of the window systems. The window's owner includes this before its
// window library, so that both agree on VkInstance and VkSurfaceKHR; nothing else outside this
// module needs it.
#include <vulkan/vulkan_core.h>
