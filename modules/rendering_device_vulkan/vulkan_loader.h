#pragma once

namespace gnomon {

/// Throws an Error with the next step if the system has no Vulkan loader. To be called before any
/// function of Vulkan: on Windows the loader is a library that is loaded at the first call. On
/// other systems the program does not start without it.
void check_vulkan_loader();

} // namespace gnomon
