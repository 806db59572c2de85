#pragma once

#include "modules/rendering_device/rendering_device_impl.h"

namespace gnomon {

struct Swapchain::Impl {
	RenderingDevice &owner;
	RenderingDevice::Impl &device;
	VkSurfaceKHR surface = VK_NULL_HANDLE;
	VkSwapchainKHR swapchain = VK_NULL_HANDLE;
	VkSurfaceFormatKHR format = {};
	glm::uvec2 size_px = glm::uvec2(0);
	glm::uvec2 wanted_size_px = glm::uvec2(0); // the window's when the images were made
	bool is_out_of_date = false;
	struct Image {
		TextureRID texture;
		VkSemaphore rendered = VK_NULL_HANDLE; // presenting waits for it
	};
	std::vector<Image> images;
	std::optional<uint32_t> acquired_index; // until it is presented
	VkSemaphore acquired_semaphore = VK_NULL_HANDLE;

	explicit Impl(RenderingDevice &p_owner) : owner(p_owner), device(p_owner.get_impl()) {}
	void choose_format();
	/// False while the window has no area.
	bool recreate(glm::uvec2 p_window_size_px);
	void destroy_images();
	VkSemaphore get_present_semaphore() const { return images[*acquired_index].rendered; }
	void present();
};

} // namespace gnomon
