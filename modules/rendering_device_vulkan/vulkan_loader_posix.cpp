#include "modules/rendering_device_vulkan/vulkan_loader.h"

void gnomon::check_vulkan_loader() {}
