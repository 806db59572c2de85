#pragma once

#include "modules/rendering_device/rendering_device.h"
#include "modules/rendering_device/swapchain.h"

#include <glm/glm.hpp>

#include <memory>
#include <string>
#include <vector>

struct GLFWwindow;

namespace gnomon {

/// A desktop window and its keyboard. Only one at a time.
class Window {
public:
	/// Without a display: an Error whose message ends with the advice.
	Window(const std::string &p_title, glm::uvec2 p_size_px, const std::string &p_advice);
	~Window();
	Window(const Window &) = delete;
	Window &operator=(const Window &) = delete;

	/// Returns DeviceOptions::instance_extensions for drawing in windows of this desktop.
	static std::vector<std::string> get_instance_extensions();
	/// Creates the swapchain of this window, for a device that was created with needs_surface.
	/// Destroy it before the window and the device.
	std::unique_ptr<Swapchain> create_swapchain(RenderingDevice &r_device);

	/// Processes events. Returns false once the user has closed the window.
	bool poll();
	void close();
	/// Cancels closing after the user closed the window, so that poll returns true again.
	void keep_open();
	/// Size of the drawable area; 0 while minimised.
	glm::uvec2 get_size_px() const;
	/// Content scale of the desktop: 1 on a normal screen, 2 on a high-density one.
	float get_scale() const;
	void set_title(const std::string &p_title);

	bool is_down(int p_glfw_key) const;
	/// Returns the GLFW handle, for a user interface library that adds its own callbacks.
	GLFWwindow *get_handle() { return window; }
	/// A key press, reported even if the key has been released since.
	struct KeyPress {
		int key = 0;	   // GLFW's code
		int modifiers = 0; // GLFW's bits, as they were then
	};
	/// Key presses since the last poll, in order.
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
