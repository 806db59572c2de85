#include "modules/rendering_device/tests/testing.h"

#include "modules/rendering_device_vulkan/vulkan_device.h"

namespace gnomon {

namespace {

VulkanDevice &get_vulkan_device(RenderingDevice &r_device) {
	return static_cast<VulkanDevice &>(r_device); // the only backend of this program
}

} // namespace

void inject_fault(RenderingDevice &r_device, const std::string &p_fault) {
	get_vulkan_device(r_device).injected_fault = parse_injected_fault(p_fault);
}

void release_injected_hang(RenderingDevice &r_device) {
	VulkanDevice &device = get_vulkan_device(r_device);
	const VkSemaphoreSignalInfo info = { .sType = VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO,
		.semaphore = device.hang_semaphore,
		.value = 1 }; // the value that the blocked submission waits for
	device.check(vkSignalSemaphore(device.device, &info), "vkSignalSemaphore");
}

std::vector<std::string> list_live_resources(RenderingDevice &r_device) {
	std::vector<std::string> names;
	for (const LiveResource &resource : get_vulkan_device(r_device).find_live_resources()) {
		names.push_back(resource.name);
	}
	return names;
}

uint32_t get_pipeline_count(RenderingDevice &r_device) {
	return static_cast<uint32_t>(get_vulkan_device(r_device).pipelines.size());
}

ExpectedValidationMessages::ExpectedValidationMessages() :
		before(collect_validation_messages(&messages)) {}

ExpectedValidationMessages::~ExpectedValidationMessages() {
	collect_validation_messages(before);
}

} // namespace gnomon
