#include "modules/rendering_device_vulkan/vulkan_instance.h"

#include "modules/core/error.h"
#include "modules/rendering_device_vulkan/vulkan_loader.h"

#include <algorithm>
#include <cstring>
#include <map>

namespace gnomon {

namespace {

constexpr const char *VALIDATION_LAYER = "VK_LAYER_KHRONOS_validation";

std::vector<VkExtensionProperties> find_instance_extensions(const char *p_layer) {
	return list_all<VkExtensionProperties>(vkEnumerateInstanceExtensionProperties, p_layer);
}

bool has_validation_layer() {
	const auto layers = list_all<VkLayerProperties>(vkEnumerateInstanceLayerProperties);
	return std::any_of(layers.begin(), layers.end(), [](const VkLayerProperties &p_layer) {
		return std::strcmp(p_layer.layerName, VALIDATION_LAYER) == 0;
	});
}

// The errors of the calls in use.
const std::map<VkResult, std::string> RESULT_NAMES = {
	{ VK_ERROR_OUT_OF_HOST_MEMORY, "VK_ERROR_OUT_OF_HOST_MEMORY" },
	{ VK_ERROR_OUT_OF_DEVICE_MEMORY, "VK_ERROR_OUT_OF_DEVICE_MEMORY" },
	{ VK_ERROR_INITIALIZATION_FAILED, "VK_ERROR_INITIALIZATION_FAILED" },
	{ VK_ERROR_DEVICE_LOST, "VK_ERROR_DEVICE_LOST" },
	{ VK_ERROR_LAYER_NOT_PRESENT, "VK_ERROR_LAYER_NOT_PRESENT" },
	{ VK_ERROR_EXTENSION_NOT_PRESENT, "VK_ERROR_EXTENSION_NOT_PRESENT" },
	{ VK_ERROR_FEATURE_NOT_PRESENT, "VK_ERROR_FEATURE_NOT_PRESENT" },
	{ VK_ERROR_INCOMPATIBLE_DRIVER, "VK_ERROR_INCOMPATIBLE_DRIVER" },
	{ VK_ERROR_TOO_MANY_OBJECTS, "VK_ERROR_TOO_MANY_OBJECTS" },
	{ VK_ERROR_FORMAT_NOT_SUPPORTED, "VK_ERROR_FORMAT_NOT_SUPPORTED" },
	{ VK_ERROR_SURFACE_LOST_KHR, "VK_ERROR_SURFACE_LOST_KHR" },
	{ VK_ERROR_NATIVE_WINDOW_IN_USE_KHR, "VK_ERROR_NATIVE_WINDOW_IN_USE_KHR" },
	{ VK_ERROR_OUT_OF_DATE_KHR, "VK_ERROR_OUT_OF_DATE_KHR" },
};

} // namespace

bool has_extension(
		const std::vector<VkExtensionProperties> &p_extensions, const std::string &p_name) {
	return std::any_of(p_extensions.begin(), p_extensions.end(),
			[&](const VkExtensionProperties &p_extension) {
				return p_name == p_extension.extensionName;
			});
}

std::string get_result_name(VkResult p_result) {
	const auto found = RESULT_NAMES.find(p_result);
	return found != RESULT_NAMES.end() ? found->second
									   : text("VkResult ", static_cast<int>(p_result));
}

VulkanInstance::VulkanInstance(const DeviceOptions &p_options) {
	check_vulkan_loader();
	std::vector<VkExtensionProperties> available = find_instance_extensions(nullptr);
	std::vector<const char *> layers;
	std::vector<const char *> extensions;
	bool has_validation_features = false;
	if (p_options.validation) {
		if (!has_validation_layer()) {
			fail("The Vulkan layer ", VALIDATION_LAYER, " is not installed. Install it, e.g. `apt ",
					"install vulkan-validationlayers`, or run without --validation.");
		}
		layers.push_back(VALIDATION_LAYER);
		for (const VkExtensionProperties &extension : find_instance_extensions(VALIDATION_LAYER)) {
			available.push_back(extension);
		}
		has_validation_features =
				has_extension(available, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
		if (has_validation_features) {
			extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
		}
	}
	for (const std::string &name : p_options.instance_extensions) {
		if (!has_extension(available, name)) {
			fail("Vulkan lacks the instance extension ", name,
					", which the window needs. Install a ",
					"driver that can show windows, or run with --headless.");
		}
		extensions.push_back(name.c_str());
	}
	is_debug_utils_enabled = has_extension(available, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
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
		.pNext = is_debug_utils_enabled ? &messenger_info : nullptr, // for vkCreateInstance
		.enabledValidationFeatureCount = 1,
		.pEnabledValidationFeatures = enabled
	};
	const VkInstanceCreateInfo info = { .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
		.pNext = has_validation_features ? &validation_features : nullptr,
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
