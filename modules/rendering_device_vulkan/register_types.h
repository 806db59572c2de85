#pragma once

#include "modules/core/module_registry.h"

namespace gnomon {

void initialize_rendering_device_vulkan_module(ModuleLevel p_level);
void uninitialize_rendering_device_vulkan_module(ModuleLevel p_level);

} // namespace gnomon
