#pragma once

#include "modules/rendering_device/resource_types.h"

#include <optional>

namespace gnomon {

/// Images of a window. The window's owner makes it, for a device that was created with
/// DeviceOptions::needs_surface; it ends before the device.
class Swapchain {
public:
	Swapchain() = default;
	virtual ~Swapchain() = default;
	Swapchain(const Swapchain &) = delete;
	Swapchain &operator=(const Swapchain &) = delete;

	/// The next image to draw, sRGB-encoded values as stored (write encoded values), or nothing
	/// while the window has no area. Recreates itself after a resize. Before begin_commands or
	/// after it. The image starts without content (Access::NONE) and must end with Access::PRESENT:
	/// the submission that brings it there presents it. An image that no submission brought there
	/// is handed out again. The handle is a COLOR_ATTACHMENT texture of RGBA8_UNORM or
	/// BGRA8_UNORM, see RenderingDevice::get_desc.
	virtual std::optional<TextureRID> acquire(glm::uvec2 p_window_size_px) = 0;
	virtual glm::uvec2 get_size_px() const = 0;
};

} // namespace gnomon
