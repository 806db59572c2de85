#pragma once

#include "modules/rendering_device/rendering_device.h"
#include "modules/rendering_device_vulkan/vulkan_handles.h"

#include <string>
#include <vector>

namespace gnomon {

/// "VK_ERROR_DEVICE_LOST", or the number of a result that has no name here.
std::string get_result_name(VkResult p_result);

/// The VkInstance with its validation messenger; destroyed with this object.
class VulkanInstance {
public:
	/// No loader or no driver, a missing layer or extension: an Error that names what to install.
	explicit VulkanInstance(const DeviceOptions &p_options);
	~VulkanInstance();
	VulkanInstance(const VulkanInstance &) = delete;
	VulkanInstance &operator=(const VulkanInstance &) = delete;

	VkInstance get() const { return instance; }
	/// It is not destroyed, since a device that cannot be ended belongs to it.
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
/// In the order in which --device counts them.
std::vector<PhysicalDevice> find_physical_devices(VkInstance p_instance, bool p_needs_surface);
/// The one that DeviceOptions::device names, or the best usable one. No such device: an Error that
/// lists those there are, with the reason for each that is not usable.
const PhysicalDevice &choose_device(
		const std::vector<PhysicalDevice> &p_devices, const std::string &p_wanted);
bool has_device_extension(VkPhysicalDevice p_device, const char *p_name);

} // namespace gnomon
