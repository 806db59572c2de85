#pragma once

// The interface of this backend for the owner of a window.

#include "modules/rendering_device/rendering_device.h"
#include "modules/rendering_device/swapchain.h"
#include "modules/rendering_device_vulkan/vulkan_handles.h"

#include <functional>
#include <memory>

namespace gnomon {

/// Creates the surface with the window system's own call, so that this module needs no window
/// library.
using CreateSurface = std::function<VkSurfaceKHR(VkInstance)>;

/// Creates the swapchain for a device that was created with needs_surface and the window's instance
/// extensions. A device has at most one at a time. A window that the device cannot present to is an
/// Error.
std::unique_ptr<Swapchain> create_window_swapchain(
		RenderingDevice &r_device, const CreateSurface &p_create_surface);

} // namespace gnomon
