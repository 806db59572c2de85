#include "modules/editor/editor_question.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

namespace gnomon {

bool draw_question(const EditorQuestion &p_question) {
	ImGui::OpenPopup(p_question.title);
	if (!ImGui::BeginPopupModal(p_question.title, nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
		return false;
	}
	ImGui::TextUnformatted(p_question.text.c_str());
	bool is_answered = false;
	if (ImGui::Button(p_question.yes)) {
		p_question.on_yes();
		is_answered = true;
	}
	ImGui::SameLine();
	if (ImGui::Button(p_question.no)) {
		p_question.on_no();
		is_answered = true;
	}
	if (p_question.may_cancel) {
		ImGui::SameLine();
		is_answered |= ImGui::Button("Cancel") || ImGui::IsKeyPressed(GLFW_KEY_ESCAPE, false);
	}
	if (is_answered) {
		ImGui::CloseCurrentPopup();
	}
	ImGui::EndPopup();
	return is_answered;
}

} // namespace gnomon
