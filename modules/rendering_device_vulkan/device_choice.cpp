#include "modules/core/error.h"
#include "modules/rendering_device_vulkan/vulkan_instance.h"

#include <algorithm>
#include <cctype>

namespace gnomon {

namespace {

constexpr uint32_t NEEDED_PUSH_CONSTANT_BYTES = 128; // see CommandList::push_constants

// Best type first.
const std::pair<VkPhysicalDeviceType, const char *> TYPES[] = {
	{ VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, "discrete GPU" },
	{ VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU, "integrated GPU" },
	{ VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU, "virtual GPU" },
	{ VK_PHYSICAL_DEVICE_TYPE_CPU, "CPU" },
};

const char *get_type_name(VkPhysicalDeviceType p_type) {
	const auto found =
			std::ranges::find(TYPES, p_type, [](const auto &p_row) { return p_row.first; });
	return found != std::end(TYPES) ? found->second : "other";
}

/// Lower is better.
ptrdiff_t get_type_rank(const std::string &p_type) {
	return std::ranges::find(TYPES, p_type, [](const auto &p_row) { return p_row.second; }) - TYPES;
}

std::string get_version_text(uint32_t p_version) {
	return text(VK_API_VERSION_MAJOR(p_version), ".", VK_API_VERSION_MINOR(p_version), ".",
			VK_API_VERSION_PATCH(p_version));
}

uint64_t find_device_memory_bytes(VkPhysicalDevice p_device) {
	VkPhysicalDeviceMemoryProperties properties;
	vkGetPhysicalDeviceMemoryProperties(p_device, &properties);
	uint64_t largest = 0;
	for (uint32_t heap = 0; heap < properties.memoryHeapCount; ++heap) {
		if (properties.memoryHeaps[heap].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) {
			largest = std::max<uint64_t>(largest, properties.memoryHeaps[heap].size);
		}
	}
	return largest;
}

/// Returns the first queue family with graphics and compute, or nothing.
std::optional<uint32_t> find_queue_family(VkPhysicalDevice p_device) {
	const auto families =
			list_all<VkQueueFamilyProperties>(vkGetPhysicalDeviceQueueFamilyProperties, p_device);
	constexpr VkQueueFlags NEEDED = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
	for (uint32_t family = 0; family < families.size(); ++family) {
		if ((families[family].queueFlags & NEEDED) == NEEDED) {
			return family;
		}
	}
	return std::nullopt;
}

/// Returns why a device with Vulkan 1.3 or later cannot be used; empty if it can.
std::string find_missing_feature(VkPhysicalDevice p_device, bool p_needs_surface) {
	VkPhysicalDeviceVulkan13Features features13 = {
		.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES
	};
	VkPhysicalDeviceVulkan12Features features12 = {
		.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &features13
	};
	VkPhysicalDeviceFeatures2 features = { .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
		.pNext = &features12 };
	vkGetPhysicalDeviceFeatures2(p_device, &features);
	VkPhysicalDeviceProperties properties;
	vkGetPhysicalDeviceProperties(p_device, &properties);
	VkFormatProperties depth;
	vkGetPhysicalDeviceFormatProperties(p_device, VK_FORMAT_D32_SFLOAT, &depth);
	constexpr VkFormatFeatureFlags DEPTH_USES =
			VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT;
	const struct {
		bool is_present;
		const char *name;
	} NEEDS[] = {
		{ features13.dynamicRendering == VK_TRUE, "dynamicRendering" },
		{ features13.synchronization2 == VK_TRUE, "synchronization2" },
		{ features13.maintenance4 == VK_TRUE, "maintenance4" },
		{ features12.timelineSemaphore == VK_TRUE, "timelineSemaphore" },
		{ properties.limits.maxPushConstantsSize >= NEEDED_PUSH_CONSTANT_BYTES,
				"128 bytes of push constants" },
		{ (depth.optimalTilingFeatures & DEPTH_USES) == DEPTH_USES, "32-bit float depth" },
		{ find_queue_family(p_device).has_value(), "a queue for graphics and compute" },
		{ !p_needs_surface || has_device_extension(p_device, VK_KHR_SWAPCHAIN_EXTENSION_NAME),
				"VK_KHR_swapchain, which a window needs" },
	};
	for (const auto &need : NEEDS) {
		if (!need.is_present) {
			return text("lacks ", need.name);
		}
	}
	return "";
}

std::string to_lower(std::string p_text) {
	for (char &letter : p_text) {
		letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
	}
	return p_text;
}

std::string describe_devices(const std::vector<PhysicalDevice> &p_devices) {
	std::string list;
	for (const PhysicalDevice &device : p_devices) {
		list += text(list.empty() ? "" : ", ", device.info.index, " \"", device.info.name, "\"");
		if (!device.info.is_usable) {
			list += " (not usable: " + device.info.refusal + ")";
		}
	}
	return list;
}

/// Returns the device with this index, else the first usable one whose name contains the text, else
/// the first unusable one; null if there is none.
const PhysicalDevice *find_named_device(
		const std::vector<PhysicalDevice> &p_devices, const std::string &p_requested) {
	for (const PhysicalDevice &device : p_devices) {
		if (text(device.info.index) == p_requested) {
			return &device;
		}
	}
	const PhysicalDevice *found = nullptr;
	for (const PhysicalDevice &device : p_devices) {
		const bool is_match =
				to_lower(device.info.name).find(to_lower(p_requested)) != std::string::npos;
		if (is_match && (!found || (device.info.is_usable && !found->info.is_usable))) {
			found = &device;
		}
	}
	return found;
}

} // namespace

bool has_device_extension(VkPhysicalDevice p_device, const char *p_name) {
	return has_extension(list_all<VkExtensionProperties>(
								 vkEnumerateDeviceExtensionProperties, p_device, nullptr),
			p_name);
}

std::vector<PhysicalDevice> find_physical_devices(VkInstance p_instance, bool p_needs_surface) {
	std::vector<PhysicalDevice> devices;
	for (VkPhysicalDevice handle :
			list_all<VkPhysicalDevice>(vkEnumeratePhysicalDevices, p_instance)) {
		PhysicalDevice device;
		device.handle = handle;
		VkPhysicalDeviceDriverProperties driver = {
			.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES
		};
		VkPhysicalDeviceProperties2 properties = {
			.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver
		};
		vkGetPhysicalDeviceProperties2(device.handle, &properties);
		const uint32_t version = properties.properties.apiVersion;
		device.info.index = static_cast<uint32_t>(devices.size());
		device.info.name = properties.properties.deviceName;
		device.info.driver = text(driver.driverName, " ", driver.driverInfo);
		device.info.type = get_type_name(properties.properties.deviceType);
		device.info.api_version = get_version_text(version);
		device.info.memory_bytes = find_device_memory_bytes(device.handle);
		if (version < VK_API_VERSION_1_3) {
			device.info.refusal = text("Vulkan ", VK_API_VERSION_MAJOR(version), ".",
					VK_API_VERSION_MINOR(version), ", 1.3 is needed");
		} else {
			device.info.refusal = find_missing_feature(device.handle, p_needs_surface);
		}
		device.info.is_usable = device.info.refusal.empty();
		device.queue_family = find_queue_family(device.handle).value_or(0);
		devices.push_back(std::move(device));
	}
	return devices;
}

const PhysicalDevice &choose_device(
		const std::vector<PhysicalDevice> &p_devices, const std::string &p_requested) {
	if (p_devices.empty()) {
		fail("No Vulkan device was found. Install a driver, e.g. `apt install ",
				"mesa-vulkan-drivers`, or the driver of your graphics card.");
	}
	if (!p_requested.empty()) {
		const PhysicalDevice *device = find_named_device(p_devices, p_requested);
		if (!device) {
			fail("Vulkan device \"", p_requested,
					"\" does not exist. There are: ", describe_devices(p_devices),
					". Give an index or a part of a name to ", "--device.");
		}
		if (!device->info.is_usable) {
			fail("Vulkan device \"", device->info.name, "\" cannot be used (", device->info.refusal,
					"). There are: ", describe_devices(p_devices),
					". Choose another with --device, or update the driver.");
		}
		return *device;
	}
	const PhysicalDevice *best = nullptr;
	for (const PhysicalDevice &device : p_devices) {
		if (device.info.is_usable &&
				(!best || get_type_rank(device.info.type) < get_type_rank(best->info.type))) {
			best = &device;
		}
	}
	if (!best) {
		fail("No Vulkan device can be used. There are: ", describe_devices(p_devices),
				". Update the driver, or install one, e.g. `apt install mesa-vulkan-drivers`.");
	}
	return *best;
}

std::vector<DeviceInfo> find_rendering_devices() {
	std::vector<DeviceInfo> infos;
	try {
		const VulkanInstance instance{ DeviceOptions() };
		for (const PhysicalDevice &device :
				find_physical_devices(instance.get(), /*p_needs_surface=*/false)) {
			infos.push_back(device.info);
		}
	} catch (...) {
		// Without Vulkan there are none; create_rendering_device reports what to install.
	}
	return infos;
}

} // namespace gnomon
