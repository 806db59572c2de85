#pragma once

#include "modules/rendering_device/rendering_device.h"
#include "modules/rendering_device/swapchain.h"

#include <glm/glm.hpp>

#include <memory>
#include <string>
#include <vector>

struct GLFWwindow;

namespace gnomon {

/// A window of the desktop and its keys. One at a time.
class Window {
public:
	/// No display: an Error that ends with the advice.
	Window(const std::string &p_title, glm::uvec2 p_size_px, const std::string &p_advice);
	~Window();
	Window(const Window &) = delete;
	Window &operator=(const Window &) = delete;

	/// What a device needs to draw in windows of this desktop: DeviceOptions::instance_extensions.
	static std::vector<std::string> get_instance_extensions();
	/// The images of this window, for a device that was created with needs_surface; they end before
	/// the window and the device.
	std::unique_ptr<Swapchain> create_swapchain(RenderingDevice &r_device);

	/// Reads events. False once the user closed the window.
	bool poll();
	void close();
	/// After the user closed it: takes that back, so that poll goes on.
	void keep_open();
	/// Of the drawable area; 0 while minimised.
	glm::uvec2 get_size_px() const;
	/// Of the desktop: 1 on a normal screen, 2 on a dense one.
	float get_scale() const;
	void set_title(const std::string &p_title);

	bool is_down(int p_glfw_key) const;
	/// For a user interface library, which adds its own callbacks.
	GLFWwindow *get_handle() { return window; }
	/// A key that went down, even if it is up again.
	struct KeyPress {
		int key = 0;	   // GLFW's code
		int modifiers = 0; // GLFW's bits, as they were then
	};
	/// Since the last poll, in order.
	const std::vector<KeyPress> &get_key_presses() const { return key_presses; }
	/// Movement since the last poll while the right button is held, in pixels.
	glm::dvec2 get_drag_px() const { return drag_px; }

private:
	GLFWwindow *window = nullptr;
	std::vector<KeyPress> key_presses;
	glm::dvec2 cursor_px = glm::dvec2(0.0);
	glm::dvec2 drag_px = glm::dvec2(0.0);
};

} // namespace gnomon
