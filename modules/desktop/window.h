#pragma once

#include "modules/rendering_device/rendering_device.h"
#include "modules/rendering_device/swapchain.h"

#include <glm/glm.hpp>

#include <memory>
#include <string>
#include <vector>

struct GLFWwindow;

namespace gnomon {

/// A GLFW window with its keyboard and mouse input. Only one may exist at a time.
class Window {
public:
	/// Opens the window. A missing display or Vulkan driver is an Error; p_advice is a sentence
	/// that ends its message.
	Window(const std::string &p_title, glm::uvec2 p_size_px, const std::string &p_advice);
	~Window();
	Window(const Window &) = delete;
	Window &operator=(const Window &) = delete;

	/// Returns the Vulkan instance extensions that drawing in a window needs, for
	/// DeviceOptions::instance_extensions. Call it while a window exists.
	static std::vector<std::string> get_instance_extensions();
	/// Creates the swapchain of this window. The device must have been created with
	/// DeviceOptions::needs_surface and the extensions of get_instance_extensions(). Destroy the
	/// swapchain before the window and the device.
	std::unique_ptr<Swapchain> create_swapchain(RenderingDevice &r_device);

	/// Processes events. Returns false once the user or close() has closed the window.
	bool poll();
	/// Makes poll return false. The window itself stays until the destructor.
	void close();
	/// Cancels closing: poll returns true again.
	void keep_open();
	/// Returns the size of the drawable area; 0 while minimised.
	glm::uvec2 get_size_px() const;
	/// Returns the desktop's content scale: 1 on a normal screen, 2 on a high-density one.
	float get_scale() const;
	void set_title(const std::string &p_title);

	/// Whether the key, a GLFW_KEY_ constant, is pressed now.
	bool is_down(int p_glfw_key) const;
	/// Returns the GLFW handle, for a user interface library that adds its own callbacks.
	GLFWwindow *get_handle() { return window; }
	/// A key press. It is reported even if the key was released before the next poll.
	struct KeyPress {
		int key = 0;	   // a GLFW_KEY_ constant
		int modifiers = 0; // GLFW_MOD_ bits at the time of the press
	};
	/// Returns the key presses that the last poll processed, in order.
	const std::vector<KeyPress> &get_key_presses() const { return key_presses; }
	/// Returns how far the mouse moved between the last two polls, in pixels, if the right button
	/// is pressed; else 0.
	glm::dvec2 get_drag_px() const { return drag_px; }

private:
	GLFWwindow *window = nullptr;
	std::vector<KeyPress> key_presses;
	glm::dvec2 cursor_px = glm::dvec2(0.0);
	glm::dvec2 drag_px = glm::dvec2(0.0);
};

} // namespace gnomon
