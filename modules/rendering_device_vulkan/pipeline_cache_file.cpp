#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/log.h"
#include "modules/rendering_device_vulkan/pipeline_cache_header.h"
#include "modules/rendering_device_vulkan/vulkan_device.h"

#include <iomanip>

namespace gnomon {

std::string VulkanDevice::get_cache_name() const {
	VkPhysicalDeviceProperties properties;
	vkGetPhysicalDeviceProperties(physical.handle, &properties);
	std::ostringstream name;
	name << "pipelines_" << std::hex << properties.vendorID << "_" << properties.deviceID << "_"
		 << properties.driverVersion << "_";
	for (const uint8_t byte : properties.pipelineCacheUUID) {
		name << std::setw(2) << std::setfill('0') << static_cast<unsigned>(byte);
	}
	name << ".bin";
	return name.str();
}

void VulkanDevice::load_pipeline_cache() {
	VkPhysicalDeviceProperties properties;
	vkGetPhysicalDeviceProperties(physical.handle, &properties);
	std::vector<uint8_t> bytes = load_cache_entry(get_cache_name());
	if (!bytes.empty() && !is_pipeline_cache_of(bytes, properties)) {
		// The file's name identifies the driver, so the file was damaged or copied.
		log_info("Pipeline cache ", get_cache_name(),
				" was not written by this driver; it is ignored.");
		bytes.clear();
	}
	saved_cache_hash = bytes.empty() ? 0 : compute_hash(bytes);
	VkPipelineCacheCreateInfo info = { .sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
		.initialDataSize = bytes.size(),
		.pInitialData = bytes.data() };
	VkResult result = vkCreatePipelineCache(device, &info, nullptr, &pipeline_cache);
	if (result != VK_SUCCESS && !bytes.empty()) {
		log_info("Pipeline cache ", get_cache_name(), " is refused by the driver; it is ignored.");
		info.initialDataSize = 0;
		result = vkCreatePipelineCache(device, &info, nullptr, &pipeline_cache);
	}
	check(result, "vkCreatePipelineCache");
}

void VulkanDevice::save_pipeline_cache() {
	if (!pipeline_cache || !lost_text.empty()) {
		return; // the data of a lost device cannot be trusted
	}
	size_t size = 0;
	if (vkGetPipelineCacheData(device, pipeline_cache, &size, nullptr) != VK_SUCCESS) {
		return;
	}
	std::vector<uint8_t> bytes(size);
	if (vkGetPipelineCacheData(device, pipeline_cache, &size, bytes.data()) != VK_SUCCESS) {
		return;
	}
	bytes.resize(size);
	const uint64_t hash = compute_hash(bytes);
	if (hash != saved_cache_hash) {
		save_cache_entry(get_cache_name(), bytes);
		saved_cache_hash = hash;
	}
}

} // namespace gnomon
