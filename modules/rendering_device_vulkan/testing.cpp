#include "modules/rendering_device/testing.h"

#include "modules/rendering_device_vulkan/vulkan_device.h"

namespace gnomon {

namespace {

VulkanDevice &get_vulkan_device(RenderingDevice &r_device) {
	return static_cast<VulkanDevice &>(r_device); // the only backend of this program
}

} // namespace

void inject_fault(RenderingDevice &r_device, Fault p_fault) {
	get_vulkan_device(r_device).injected_fault = { p_fault, {}, {} };
}

void release_injected_hang(RenderingDevice &r_device) {
	VulkanDevice &device = get_vulkan_device(r_device);
	const VkSemaphoreSignalInfo info = {
		.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO, .semaphore = device.never, .value = 1
	};
	device.check(vkSignalSemaphore(device.device, &info), "vkSignalSemaphore");
}

std::vector<std::string> list_live_resources(RenderingDevice &r_device) {
	return get_vulkan_device(r_device).list_live_resources();
}

} // namespace gnomon
