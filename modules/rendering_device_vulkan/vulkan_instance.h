#pragma once

#include "modules/rendering_device/rendering_device.h"
#include "modules/rendering_device_vulkan/vulkan_handles.h"

#include <string>
#include <vector>

namespace gnomon {

/// Returns a result's name, such as "VK_ERROR_DEVICE_LOST", or its number if it has none here.
std::string get_result_name(VkResult p_result);

/// Lists everything that a Vulkan enumeration function returns, given its arguments before count
/// and array.
template <typename Item, typename Function, typename... Arguments>
std::vector<Item> list_all(Function p_function, Arguments... p_arguments) {
	uint32_t count = 0;
	p_function(p_arguments..., &count, nullptr);
	std::vector<Item> items(count);
	p_function(p_arguments..., &count, items.data());
	items.resize(count);
	return items;
}
bool has_extension(
		const std::vector<VkExtensionProperties> &p_extensions, const std::string &p_name);

/// Makes the info of a messenger that counts and logs validation warnings and errors, but neither
/// performance advice nor what the loader reports about the drivers it finds.
VkDebugUtilsMessengerCreateInfoEXT make_messenger_info();
/// For tests: collects messages in r_messages instead of counting and logging them. Null: counts
/// and logs them again. Returns the previous target.
std::vector<std::string> *collect_validation_messages(std::vector<std::string> *r_messages);

/// The VkInstance with its validation messenger; destroyed with this object.
class VulkanInstance {
public:
	/// A missing driver, layer or extension is an Error that names what to install.
	explicit VulkanInstance(const DeviceOptions &p_options);
	~VulkanInstance();
	VulkanInstance(const VulkanInstance &) = delete;
	VulkanInstance &operator=(const VulkanInstance &) = delete;

	VkInstance get() const { return instance; }
	/// Leaks the instance, because a device that cannot be destroyed belongs to it.
	void abandon() { is_abandoned = true; }
	bool has_debug_utils() const { return is_debug_utils_enabled; }

private:
	VkInstance instance = VK_NULL_HANDLE;
	VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
	bool is_debug_utils_enabled = false;
	bool is_abandoned = false;
};

/// A physical device, usable or not.
struct PhysicalDevice {
	VkPhysicalDevice handle = VK_NULL_HANDLE;
	uint32_t queue_family = 0; // graphics and compute
	DeviceInfo info;
};
/// Lists the devices in the order of --device indices.
std::vector<PhysicalDevice> find_physical_devices(VkInstance p_instance, bool p_needs_surface);
/// Returns the device that DeviceOptions::device names, or the best usable one. If there is none:
/// an Error that lists the devices, with the reason for each unusable one.
const PhysicalDevice &choose_device(
		const std::vector<PhysicalDevice> &p_devices, const std::string &p_requested);
bool has_device_extension(VkPhysicalDevice p_device, const char *p_name);

} // namespace gnomon
