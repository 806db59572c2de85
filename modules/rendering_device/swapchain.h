#pragma once

#include "modules/rendering_device/rendering_device.h"

#include <functional>
#include <memory>
#include <optional>

struct VkInstance_T;
struct VkSurfaceKHR_T;

namespace gnomon {

/// Images of a window. The surface comes from the window system through a callback, so that this
/// module needs no window library and the window's owner no Vulkan.
class Swapchain {
public:
	using CreateSurface = std::function<VkSurfaceKHR_T *(VkInstance_T *)>;

	/// The device must have been created with needs_surface and the window's instance extensions.
	Swapchain(RenderingDevice &p_device, const CreateSurface &p_create_surface);
	~Swapchain();

	/// The next image to draw, sRGB-encoded values as stored (write encoded values), or nothing
	/// while the window has no area. Recreates itself after a resize. Before begin_commands or
	/// after it. The image starts without content (Access::NONE) and must end with Access::PRESENT:
	/// the submission that brings it there presents it. An image that no submission brought there
	/// is handed out again. The handle is a COLOR_ATTACHMENT and COPY_TARGET texture; as many
	/// windows store BGRA, fill it with CommandList::blit_texture, which converts. Drawing into it
	/// directly asserts where the window is not RGBA.
	std::optional<TextureRID> acquire(glm::uvec2 p_window_size_px);
	glm::uvec2 get_size_px() const;

	struct Impl;

private:
	std::unique_ptr<Impl> impl;
};

} // namespace gnomon
