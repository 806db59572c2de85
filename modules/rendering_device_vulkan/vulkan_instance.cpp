#include "modules/rendering_device_vulkan/vulkan_instance.h"

#include "modules/core/error.h"

#include <cstring>

namespace gnomon {

namespace {

constexpr const char *VALIDATION_LAYER = "VK_LAYER_KHRONOS_validation";

std::vector<VkExtensionProperties> find_instance_extensions(const char *p_layer) {
	uint32_t count = 0;
	vkEnumerateInstanceExtensionProperties(p_layer, &count, nullptr);
	std::vector<VkExtensionProperties> extensions(count);
	vkEnumerateInstanceExtensionProperties(p_layer, &count, extensions.data());
	extensions.resize(count);
	return extensions;
}

bool contains(const std::vector<VkExtensionProperties> &p_extensions, const std::string &p_name) {
	for (const VkExtensionProperties &extension : p_extensions) {
		if (p_name == extension.extensionName) {
			return true;
		}
	}
	return false;
}

bool has_validation_layer() {
	uint32_t count = 0;
	vkEnumerateInstanceLayerProperties(&count, nullptr);
	std::vector<VkLayerProperties> layers(count);
	vkEnumerateInstanceLayerProperties(&count, layers.data());
	for (uint32_t index = 0; index < count; ++index) {
		if (std::strcmp(layers[index].layerName, VALIDATION_LAYER) == 0) {
			return true;
		}
	}
	return false;
}

} // namespace

std::string get_result_name(VkResult p_result) {
	switch (p_result) {
		case VK_ERROR_OUT_OF_HOST_MEMORY:
			return "VK_ERROR_OUT_OF_HOST_MEMORY";
		case VK_ERROR_OUT_OF_DEVICE_MEMORY:
			return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
		case VK_ERROR_INITIALIZATION_FAILED:
			return "VK_ERROR_INITIALIZATION_FAILED";
		case VK_ERROR_DEVICE_LOST:
			return "VK_ERROR_DEVICE_LOST";
		case VK_ERROR_LAYER_NOT_PRESENT:
			return "VK_ERROR_LAYER_NOT_PRESENT";
		case VK_ERROR_EXTENSION_NOT_PRESENT:
			return "VK_ERROR_EXTENSION_NOT_PRESENT";
		case VK_ERROR_FEATURE_NOT_PRESENT:
			return "VK_ERROR_FEATURE_NOT_PRESENT";
		case VK_ERROR_INCOMPATIBLE_DRIVER:
			return "VK_ERROR_INCOMPATIBLE_DRIVER";
		case VK_ERROR_TOO_MANY_OBJECTS:
			return "VK_ERROR_TOO_MANY_OBJECTS";
		case VK_ERROR_FORMAT_NOT_SUPPORTED:
			return "VK_ERROR_FORMAT_NOT_SUPPORTED";
		case VK_ERROR_SURFACE_LOST_KHR:
			return "VK_ERROR_SURFACE_LOST_KHR";
		case VK_ERROR_NATIVE_WINDOW_IN_USE_KHR:
			return "VK_ERROR_NATIVE_WINDOW_IN_USE_KHR";
		case VK_ERROR_OUT_OF_DATE_KHR:
			return "VK_ERROR_OUT_OF_DATE_KHR";
		default:
			return text("VkResult ", static_cast<int>(p_result));
	}
}

VulkanInstance::VulkanInstance(const DeviceOptions &p_options) {
	std::vector<VkExtensionProperties> available = find_instance_extensions(nullptr);
	std::vector<const char *> layers;
	std::vector<const char *> extensions;
	if (p_options.validation) {
		if (!has_validation_layer()) {
			fail("The Vulkan layer ", VALIDATION_LAYER, " is not installed. Install it, e.g. `apt ",
					"install vulkan-validationlayers`, or run without --validation.");
		}
		layers.push_back(VALIDATION_LAYER);
		for (const VkExtensionProperties &extension : find_instance_extensions(VALIDATION_LAYER)) {
			available.push_back(extension);
		}
		if (contains(available, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME)) {
			extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
		}
	}
	for (const std::string &name : p_options.instance_extensions) {
		if (!contains(available, name)) {
			fail("Vulkan lacks the instance extension ", name,
					", which the window needs. Install a ",
					"driver that can show windows, or run with --headless.");
		}
		extensions.push_back(name.c_str());
	}
	is_debug_utils_enabled = contains(available, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
	if (is_debug_utils_enabled) {
		extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
	}

	const VkApplicationInfo application = { .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
		.pApplicationName = "Gnomon",
		.pEngineName = "Gnomon",
		.apiVersion = VK_API_VERSION_1_3 };
	const VkDebugUtilsMessengerCreateInfoEXT messenger_info = make_messenger_info();
	const VkValidationFeatureEnableEXT enabled[] = {
		VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT
	};
	const VkValidationFeaturesEXT validation_features = {
		.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
		.pNext = is_debug_utils_enabled ? &messenger_info : nullptr, // for the instance's own calls
		.enabledValidationFeatureCount = 1,
		.pEnabledValidationFeatures = enabled
	};
	const VkInstanceCreateInfo info = { .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
		.pNext = p_options.validation ? &validation_features : nullptr,
		.pApplicationInfo = &application,
		.enabledLayerCount = static_cast<uint32_t>(layers.size()),
		.ppEnabledLayerNames = layers.data(),
		.enabledExtensionCount = static_cast<uint32_t>(extensions.size()),
		.ppEnabledExtensionNames = extensions.data() };
	const VkResult result = vkCreateInstance(&info, nullptr, &instance);
	if (result == VK_ERROR_INCOMPATIBLE_DRIVER) {
		fail("No Vulkan device was found: no driver is installed. Install one, e.g. `apt install ",
				"mesa-vulkan-drivers`, or the driver of your graphics card.");
	}
	if (result != VK_SUCCESS) {
		fail("Vulkan does not start: vkCreateInstance returned ", get_result_name(result),
				". Check the installation with `vulkaninfo --summary`.");
	}
	if (p_options.validation && is_debug_utils_enabled) {
		const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
				vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
		create(instance, &messenger_info, nullptr, &messenger);
	}
}

VulkanInstance::~VulkanInstance() {
	if (is_abandoned) {
		return;
	}
	if (messenger) {
		const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
				vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
		destroy(instance, messenger, nullptr);
	}
	vkDestroyInstance(instance, nullptr);
}

} // namespace gnomon
