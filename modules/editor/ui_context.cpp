#include "modules/editor/ui_context.h"

#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include <cmath>

namespace gnomon {

UiContext::UiContext(Window &p_window) {
	IMGUI_CHECKVERSION();
	ImGui::CreateContext();
	ImGuiIO &io = ImGui::GetIO();
	io.IniFilename = nullptr; // the panels have fixed places
	io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
	const float scale = p_window.get_scale();
	ImFontConfig font;
	font.SizePixels = std::round(13.0f * scale);
	io.Fonts->AddFontDefault(&font);
	ImGui::StyleColorsDark();
	ImGui::GetStyle().ScaleAllSizes(scale);
	ImGui::GetStyle().WindowRounding = 0.0f;
	ImGui_ImplGlfw_InitForOther(p_window.get_handle(), true);
}

UiContext::~UiContext() {
	ImGui_ImplGlfw_Shutdown();
	ImGui::DestroyContext();
}

void UiContext::begin_frame() {
	ImGui_ImplGlfw_NewFrame();
	ImGui::NewFrame();
}

} // namespace gnomon
