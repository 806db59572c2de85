#pragma once

#include "modules/rendering_device_vulkan/vulkan_device.h"
#include "modules/rendering_device_vulkan/window_swapchain.h"

namespace gnomon {

/// The images of a window, and the semaphores of the acquired one.
class VulkanSwapchain final : public Swapchain {
public:
	VulkanSwapchain(VulkanDevice &r_device, const CreateSurface &p_create_surface);
	~VulkanSwapchain() override;
	std::optional<TextureRID> acquire(glm::uvec2 p_window_size_px) override;
	glm::uvec2 get_size_px() const override { return size_px; }

	VulkanDevice &device;
	VkSurfaceKHR surface = VK_NULL_HANDLE;
	VkSwapchainKHR swapchain = VK_NULL_HANDLE;
	VkSurfaceFormatKHR format = {};
	glm::uvec2 size_px = glm::uvec2(0);
	glm::uvec2 requested_size_px = glm::uvec2(0); // the window's size when the images were created
	bool is_out_of_date = false;
	struct Image {
		TextureRID texture;
		VkSemaphore rendered = VK_NULL_HANDLE; // presenting waits for it
	};
	std::vector<Image> images;
	std::optional<uint32_t> acquired_index; // set until the image is presented
	bool is_acquisition_awaited = false;	// a submission since then waits for the semaphore
	// One more than submissions in flight: an image may be acquired before begin_commands has
	// waited for the older one.
	static constexpr size_t ACQUISITION_COUNT = VulkanDevice::SLOT_COUNT + 1;
	VkSemaphore acquire_semaphores[ACQUISITION_COUNT] = {};
	size_t acquisition_index = 0; // of the last acquired image

	void create_semaphore(VkSemaphore &r_semaphore, const std::string &p_name);
	void choose_format();
	/// Returns false while the window has no area.
	bool recreate(glm::uvec2 p_window_size_px);
	void destroy_images();
	Format get_format() const {
		return format.format == VK_FORMAT_R8G8B8A8_UNORM ? Format::RGBA8_UNORM
														 : Format::BGRA8_UNORM;
	}

	/// What a submission must do for the image, according to the barriers recorded so far: wait for
	/// it if it is used for the first time; signal and present if it has Access::PRESENT.
	bool must_wait() const;
	bool must_present() const;
	VkSemaphore get_acquire_semaphore() const { return acquire_semaphores[acquisition_index]; }
	VkSemaphore get_rendered_semaphore() const { return images[*acquired_index].rendered; }
	void present();
};

} // namespace gnomon
