#include "modules/editor/ui_context.h"

#include "modules/editor/typeface.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include <cmath>
#include <optional>

namespace gnomon {

namespace {

const float FONT_SIZE_PX = 14.0f; // at a window scale of 1
// Pairs of first and last code point: Latin with accents, Greek and Cyrillic, for names of nodes
// and files; punctuation, the euro sign, arrows and mathematical symbols, for messages; the
// replacement character, for invalid UTF-8. 0 ends the list.
const ImWchar GLYPH_RANGES[] = { 0x20, 0x24f, 0x370, 0x52f, 0x2010, 0x2044, 0x20ac, 0x20ac, 0x2190,
	0x21ff, 0x2200, 0x22ff, 0xfffd, 0xfffd, 0 };

// Dear ImGui's GLFW backend reads the current mouse position once a frame, which may be later than
// the mouse events of that frame. After a long frame, a click would then act where the mouse is now
// instead of where the button was pressed or released. So begin_frame uses the position at the time
// of the events. The variables are global because the GLFW callbacks have no other state.
std::optional<ImVec2> last_position;
std::optional<ImVec2> button_position; // at the last press or release since the last frame

void record_position(GLFWwindow * /*p_window*/, double p_x, double p_y) {
	last_position = ImVec2(static_cast<float>(p_x), static_cast<float>(p_y));
}

void record_button_position(
		GLFWwindow * /*p_window*/, int /*p_button*/, int /*p_action*/, int /*p_modifiers*/) {
	button_position = last_position;
}

} // namespace

UiContext::UiContext(Window &p_window) {
	IMGUI_CHECKVERSION();
	ImGui::CreateContext();
	ImGuiIO &io = ImGui::GetIO();
	io.IniFilename = nullptr; // the panels have fixed positions
	io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
	const float scale = p_window.get_scale();
	ImFontConfig font;
	font.FontDataOwnedByAtlas = false;
	const std::span<const unsigned char> typeface = get_typeface();
	// ImGui only reads the data, although the parameter is not const.
	io.Fonts->AddFontFromMemoryTTF(const_cast<unsigned char *>(typeface.data()),
			static_cast<int>(typeface.size()), std::round(FONT_SIZE_PX * scale), &font,
			GLYPH_RANGES);
	ImGui::StyleColorsDark();
	ImGui::GetStyle().ScaleAllSizes(scale);
	ImGui::GetStyle().WindowRounding = 0.0f;
	button_position.reset();
	last_position.reset();
	// Dear ImGui installs its own callbacks and calls these from them.
	glfwSetMouseButtonCallback(p_window.get_handle(), record_button_position);
	glfwSetCursorPosCallback(p_window.get_handle(), record_position);
	ImGui_ImplGlfw_InitForOther(p_window.get_handle(), /*install_callbacks=*/true);
}

UiContext::~UiContext() {
	ImGui_ImplGlfw_Shutdown();
	ImGui::DestroyContext();
}

void UiContext::begin_frame() {
	ImGui_ImplGlfw_NewFrame();
	ImGuiIO &io = ImGui::GetIO();
	if (last_position && ImGui::IsMousePosValid(&io.MousePos)) { // false: not over the window
		io.MousePos = button_position.value_or(*last_position);
	}
	button_position.reset();
	ImGui::NewFrame();
}

} // namespace gnomon
