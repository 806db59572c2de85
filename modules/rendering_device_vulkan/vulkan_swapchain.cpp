#include "modules/rendering_device_vulkan/vulkan_swapchain.h"

#include "modules/core/error.h"

#include <algorithm>
#include <limits>

namespace gnomon {

namespace {

constexpr VkImageUsageFlags IMAGE_USAGE = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;

constexpr uint64_t ACQUIRE_TIMEOUT_NS = 2'000'000'000; // then acquire() returns nothing

} // namespace

std::unique_ptr<Swapchain> create_window_swapchain(
		RenderingDevice &r_device, const CreateSurface &p_create_surface) {
	return std::make_unique<VulkanSwapchain>(
			static_cast<VulkanDevice &>(r_device), p_create_surface);
}

VulkanSwapchain::VulkanSwapchain(VulkanDevice &r_device, const CreateSurface &p_create_surface) :
		device(r_device) {
	device.fail_if_lost();
	GNOMON_ASSERT(device.options.needs_surface, "the device was created without needs_surface");
	GNOMON_ASSERT(!device.swapchain, "the device already has a swapchain");
	surface = p_create_surface(device.instance->get());
	if (!surface) {
		fail("The window gave no Vulkan surface. Check that there is a display, or run with ",
				"--headless.");
	}
	VkBool32 is_supported = VK_FALSE;
	vkGetPhysicalDeviceSurfaceSupportKHR(
			device.physical.handle, device.physical.queue_family, surface, &is_supported);
	VkSurfaceCapabilitiesKHR capabilities = {};
	vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device.physical.handle, surface, &capabilities);
	if (!is_supported || (capabilities.supportedUsageFlags & IMAGE_USAGE) != IMAGE_USAGE) {
		vkDestroySurfaceKHR(device.instance->get(), surface, nullptr);
		fail("Device \"", device.physical.info.name, "\" cannot show this window. Choose another ",
				"with --device, or run with --headless.");
	}
	try {
		choose_format();
		for (VkSemaphore &semaphore : acquire_semaphores) {
			create_semaphore(semaphore, "window image acquired");
		}
	} catch (...) {
		for (VkSemaphore semaphore : acquire_semaphores) {
			vkDestroySemaphore(device.device, semaphore, nullptr);
		}
		vkDestroySurfaceKHR(device.instance->get(), surface, nullptr);
		throw;
	}
	device.swapchain = this;
}

VulkanSwapchain::~VulkanSwapchain() {
	device.swapchain = nullptr;
	if (!device.try_wait_idle()) {
		return; // all of it may still be in use
	}
	destroy_images();
	vkDestroySwapchainKHR(device.device, swapchain, nullptr);
	for (VkSemaphore semaphore : acquire_semaphores) {
		vkDestroySemaphore(device.device, semaphore, nullptr);
	}
	vkDestroySurfaceKHR(device.instance->get(), surface, nullptr);
}

void VulkanSwapchain::create_semaphore(VkSemaphore &r_semaphore, const std::string &p_name) {
	const VkSemaphoreCreateInfo info = { .sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO };
	device.check(
			vkCreateSemaphore(device.device, &info, nullptr, &r_semaphore), "vkCreateSemaphore");
	device.set_name(VK_OBJECT_TYPE_SEMAPHORE, r_semaphore, p_name);
}

void VulkanSwapchain::choose_format() {
	const auto formats = list_all<VkSurfaceFormatKHR>(
			vkGetPhysicalDeviceSurfaceFormatsKHR, device.physical.handle, surface);
	for (const VkFormat preferred : { VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_UNORM }) {
		for (const VkSurfaceFormatKHR &offered : formats) {
			if (offered.format == preferred &&
					offered.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) {
				format = offered;
				return;
			}
		}
	}
	fail("Device \"", device.physical.info.name,
			"\" offers no window format of 8 bits per channel. ",
			"Choose another with --device, or run with --headless.");
}

void VulkanSwapchain::destroy_images() {
	for (Image &image : images) {
		TextureResource texture = device.textures.remove(image.texture);
		device.destroy(texture);
		vkDestroySemaphore(device.device, image.rendered, nullptr);
	}
	images.clear();
}

bool VulkanSwapchain::recreate(glm::uvec2 p_window_size_px) {
	device.wait_for(device.submitted_number);
	device.check(vkDeviceWaitIdle(device.device), "vkDeviceWaitIdle"); // for presentation
	VkSurfaceCapabilitiesKHR capabilities = {};
	device.check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(
						 device.physical.handle, surface, &capabilities),
			"vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
	VkExtent2D extent = capabilities.currentExtent;
	if (extent.width == std::numeric_limits<uint32_t>::max()) {
		// The window system takes the window's size from the images.
		extent.width = std::clamp(p_window_size_px.x, capabilities.minImageExtent.width,
				capabilities.maxImageExtent.width);
		extent.height = std::clamp(p_window_size_px.y, capabilities.minImageExtent.height,
				capabilities.maxImageExtent.height);
	}
	if (extent.width == 0 || extent.height == 0) {
		return false;
	}
	uint32_t image_count = std::max(capabilities.minImageCount + 1, 3u);
	if (capabilities.maxImageCount > 0) {
		image_count = std::min(image_count, capabilities.maxImageCount);
	}
	const auto opaque = (capabilities.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR)
			? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
			: VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
	const VkSwapchainCreateInfoKHR info = { .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
		.surface = surface,
		.minImageCount = image_count,
		.imageFormat = format.format,
		.imageColorSpace = format.colorSpace,
		.imageExtent = extent,
		.imageArrayLayers = 1,
		.imageUsage = IMAGE_USAGE,
		.preTransform = capabilities.currentTransform,
		.compositeAlpha = opaque,
		.presentMode = VK_PRESENT_MODE_FIFO_KHR, // the only one that every device has
		.clipped = VK_TRUE,
		.oldSwapchain = swapchain };
	VkSwapchainKHR made = VK_NULL_HANDLE;
	const VkResult result = vkCreateSwapchainKHR(device.device, &info, nullptr, &made);
	destroy_images();
	vkDestroySwapchainKHR(device.device, swapchain, nullptr);
	swapchain = made;
	device.check(result, "vkCreateSwapchainKHR");
	size_px = { extent.width, extent.height };
	requested_size_px = p_window_size_px;
	is_out_of_date = false;

	for (VkImage handle : list_all<VkImage>(vkGetSwapchainImagesKHR, device.device, swapchain)) {
		const size_t index = images.size();
		TextureResource texture;
		texture.desc = { .name = text("window image ", index),
			.format = get_format(),
			.size_px = size_px,
			.usage = TextureUsage::COLOR_ATTACHMENT };
		texture.image = handle;
		texture.is_swapchain = true;
		device.set_name(VK_OBJECT_TYPE_IMAGE, texture.image, texture.desc.name);
		Image image;
		image.texture = device.textures.add(std::move(texture));
		images.push_back(image);
		create_semaphore(images.back().rendered, text("image rendered ", index));
	}
	return true;
}

std::optional<TextureRID> VulkanSwapchain::acquire(glm::uvec2 p_window_size_px) {
	device.fail_if_lost();
	if (acquired_index) {
		// The previous frame was abandoned, or did not present the image.
		const TextureRID texture = images[*acquired_index].texture;
		if (!is_acquisition_awaited) {
			device.textures.get(texture).recorded_layout = VK_IMAGE_LAYOUT_UNDEFINED;
		}
		return texture;
	}
	if (p_window_size_px.x == 0 || p_window_size_px.y == 0) {
		return std::nullopt;
	}
	if (requested_size_px != p_window_size_px) {
		is_out_of_date = true;
	}
	// A window that is being resized may make both attempts fail. Then the next frame tries again.
	for (int attempt = 0; attempt < 2; ++attempt) {
		if ((is_out_of_date || !swapchain) && !recreate(p_window_size_px)) {
			return std::nullopt;
		}
		const size_t next = (acquisition_index + 1) % ACQUISITION_COUNT;
		uint32_t index = 0;
		const VkResult result = vkAcquireNextImageKHR(device.device, swapchain, ACQUIRE_TIMEOUT_NS,
				acquire_semaphores[next], VK_NULL_HANDLE, &index);
		if (result == VK_TIMEOUT || result == VK_NOT_READY) {
			return std::nullopt; // some window systems give no images for a hidden window
		}
		if (result == VK_ERROR_OUT_OF_DATE_KHR) {
			is_out_of_date = true;
			continue;
		}
		device.check(result, "vkAcquireNextImageKHR");
		is_out_of_date = result == VK_SUBOPTIMAL_KHR;
		acquired_index = index;
		acquisition_index = next;
		is_acquisition_awaited = false;
		const TextureRID texture = images[index].texture;
		device.textures.get(texture).recorded_layout = VK_IMAGE_LAYOUT_UNDEFINED;
		return texture;
	}
	return std::nullopt;
}

bool VulkanSwapchain::must_wait() const {
	return acquired_index && !is_acquisition_awaited &&
			device.textures.get(images[*acquired_index].texture).recorded_layout !=
			VK_IMAGE_LAYOUT_UNDEFINED;
}

bool VulkanSwapchain::must_present() const {
	return acquired_index &&
			device.textures.get(images[*acquired_index].texture).recorded_layout ==
			VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
}

void VulkanSwapchain::present() {
	const uint32_t index = *acquired_index;
	const VkSemaphore rendered = images[index].rendered;
	acquired_index.reset();
	const VkPresentInfoKHR info = { .sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
		.waitSemaphoreCount = 1,
		.pWaitSemaphores = &rendered,
		.swapchainCount = 1,
		.pSwapchains = &swapchain,
		.pImageIndices = &index };
	if (device.physical.info.type == "CPU") {
		// On CPU devices, presenting waits for the frame without a timeout. Wait for it with one
		// here.
		device.wait_for(device.submitted_number);
	}
	const VkResult result = vkQueuePresentKHR(device.queue, &info);
	if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR) {
		is_out_of_date = true;
		return;
	}
	device.check(result, "vkQueuePresentKHR");
}

} // namespace gnomon
