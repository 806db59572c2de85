#include "modules/desktop/window.h"

#include "modules/core/error.h"
// Must come before GLFW, which declares its Vulkan functions only after the Vulkan headers.
#include "modules/rendering_device_vulkan/vulkan_handles.h"
#include "modules/rendering_device_vulkan/window_swapchain.h"

#include <GLFW/glfw3.h>

namespace gnomon {

Window::Window(const std::string &p_title, glm::uvec2 p_size_px, const std::string &p_advice) {
	glfwSetErrorCallback([](int, const char *) {}); // errors are reported below, once
	if (!glfwInit()) {
		fail("There is no display to open a window on. ", p_advice);
	}
	if (!glfwVulkanSupported()) {
		glfwTerminate();
		fail("The window system has no Vulkan. Install a driver, for example the package ",
				"mesa-vulkan-drivers. ", p_advice);
	}
	glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
	window = glfwCreateWindow(static_cast<int>(p_size_px.x), static_cast<int>(p_size_px.y),
			p_title.c_str(), nullptr, nullptr);
	if (!window) {
		const char *reason = "unknown";
		glfwGetError(&reason);
		const std::string message = reason ? reason : "unknown";
		glfwTerminate();
		fail("Cannot open a window of ", p_size_px.x, "x", p_size_px.y, ": ", message, ". ",
				p_advice);
	}
	glfwSetWindowUserPointer(window, this);
	glfwSetKeyCallback(
			window, [](GLFWwindow *p_window, int p_key, int, int p_action, int p_modifiers) {
				if (p_action == GLFW_PRESS) {
					static_cast<Window *>(glfwGetWindowUserPointer(p_window))
							->key_presses.push_back({ p_key, p_modifiers });
				}
			});
	glfwGetCursorPos(window, &cursor_px.x, &cursor_px.y);
}

Window::~Window() {
	glfwDestroyWindow(window);
	glfwTerminate();
}

std::vector<std::string> Window::get_instance_extensions() {
	uint32_t count = 0;
	const char **names = glfwGetRequiredInstanceExtensions(&count);
	return std::vector<std::string>(names, names + count);
}

std::unique_ptr<Swapchain> Window::create_swapchain(RenderingDevice &r_device) {
	return create_window_swapchain(r_device, [this](VkInstance p_instance) {
		VkSurfaceKHR surface = VK_NULL_HANDLE;
		const VkResult result = glfwCreateWindowSurface(p_instance, window, nullptr, &surface);
		if (result != VK_SUCCESS) {
			fail("Cannot draw in the window (VkResult ", static_cast<int>(result),
					"). Check the driver.");
		}
		return surface;
	});
}

bool Window::poll() {
	key_presses.clear();
	glfwPollEvents();
	const glm::dvec2 before_px = cursor_px;
	glfwGetCursorPos(window, &cursor_px.x, &cursor_px.y);
	const bool is_dragging = glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS;
	drag_px = is_dragging ? cursor_px - before_px : glm::dvec2(0.0);
	return !glfwWindowShouldClose(window);
}

void Window::close() {
	glfwSetWindowShouldClose(window, GLFW_TRUE);
}

void Window::keep_open() {
	glfwSetWindowShouldClose(window, GLFW_FALSE);
}

glm::uvec2 Window::get_size_px() const {
	int width = 0;
	int height = 0;
	glfwGetFramebufferSize(window, &width, &height);
	return { static_cast<uint32_t>(width), static_cast<uint32_t>(height) };
}

float Window::get_scale() const {
	float x = 1;
	float y = 1;
	glfwGetWindowContentScale(window, &x, &y);
	return x;
}

void Window::set_title(const std::string &p_title) {
	glfwSetWindowTitle(window, p_title.c_str());
}

bool Window::is_down(int p_glfw_key) const {
	return glfwGetKey(window, p_glfw_key) == GLFW_PRESS;
}

} // namespace gnomon
