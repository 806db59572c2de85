#include "modules/core/log.h"
#include "modules/rendering_device_vulkan/vulkan_instance.h"

#include <cstring>
#include <mutex>

namespace gnomon {

namespace {

// Start of the message IDs of the Vulkan loader, which reports about the drivers it finds.
const char *const LOADER_PREFIX = "Loader Message";

std::mutex messages_mutex; // layers may report from the driver's threads
unsigned message_count = 0;
std::vector<std::string> *expected_messages = nullptr; // null: messages are counted and logged

VKAPI_ATTR VkBool32 VKAPI_CALL receive_message(
		VkDebugUtilsMessageSeverityFlagBitsEXT /*p_severity*/,
		VkDebugUtilsMessageTypeFlagsEXT /*p_types*/,
		const VkDebugUtilsMessengerCallbackDataEXT *p_data, void * /*p_user*/) {
	const char *name = p_data->pMessageIdName ? p_data->pMessageIdName : "";
	if (std::strncmp(name, LOADER_PREFIX, std::strlen(LOADER_PREFIX)) == 0) {
		return VK_FALSE;
	}
	const char *message = p_data->pMessage ? p_data->pMessage : "";
	{
		std::lock_guard lock(messages_mutex);
		if (expected_messages) {
			expected_messages->push_back(message);
			return VK_FALSE;
		}
		++message_count;
	}
	log_error("Validation: ", message);
	return VK_FALSE;
}

} // namespace

VkDebugUtilsMessengerCreateInfoEXT make_messenger_info() {
	return { .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
		.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
				VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
		.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT |
				VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
		.pfnUserCallback = receive_message };
}

unsigned get_validation_message_count() {
	std::lock_guard lock(messages_mutex);
	return message_count;
}

std::vector<std::string> *collect_validation_messages(std::vector<std::string> *r_messages) {
	std::lock_guard lock(messages_mutex);
	return std::exchange(expected_messages, r_messages);
}

} // namespace gnomon
