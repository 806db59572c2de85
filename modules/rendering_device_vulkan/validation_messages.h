#pragma once

#include "modules/rendering_device_vulkan/vulkan_handles.h"

namespace gnomon {

/// A messenger that counts what the layers report: warnings and errors of validation, not advice
/// on speed and not what the loader says of the drivers it finds.
VkDebugUtilsMessengerCreateInfoEXT make_messenger_info();

} // namespace gnomon
