#pragma once

#include "modules/rendering_device/resource_types.h"

#include <optional>

namespace gnomon {

/// The images of a window. The window's owner creates the swapchain, for a device that was created
/// with DeviceOptions::needs_surface, and destroys it before the device.
class Swapchain {
public:
	Swapchain() = default;
	virtual ~Swapchain() = default;
	Swapchain(const Swapchain &) = delete;
	Swapchain &operator=(const Swapchain &) = delete;

	/// Returns the next image to draw into, or nothing if there is none now: while the window has
	/// no area or is being resized, and with some window systems while it is hidden. The image is a
	/// COLOR_ATTACHMENT texture of RGBA8_UNORM or BGRA8_UNORM (see RenderingDevice::get_desc);
	/// write sRGB-encoded values. May be called before or after begin_commands. Recreates the
	/// images after a resize. The image starts without content (Access::NONE). The submission that
	/// brings it to Access::PRESENT presents it. Until then, further calls return the same image.
	virtual std::optional<TextureRID> acquire(glm::uvec2 p_window_size_px) = 0;
	virtual glm::uvec2 get_size_px() const = 0;
};

} // namespace gnomon
