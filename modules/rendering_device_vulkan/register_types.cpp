#include "modules/rendering_device_vulkan/register_types.h"

namespace gnomon {

// Nothing to register: a device is made by whoever needs one, never by loading the module.
void initialize_rendering_device_vulkan_module(ModuleLevel) {}
void uninitialize_rendering_device_vulkan_module(ModuleLevel) {}

} // namespace gnomon
