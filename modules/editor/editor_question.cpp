#include "modules/editor/editor_question.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

namespace gnomon {

bool draw_question(EditorContext &r_context, const EditorQuestion &p_question) {
	ImGui::OpenPopup(p_question.title);
	if (!ImGui::BeginPopupModal(p_question.title, nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
		return false;
	}
	ImGui::TextUnformatted(p_question.text.c_str());
	bool is_answered = false;
	const auto draw_answer = [&](const char *p_label, const std::function<void()> &p_action) {
		const bool is_pressed = ImGui::Button(p_label);
		r_context.note_item(std::string("button ") + p_label);
		if (is_pressed) {
			p_action();
			is_answered = true;
		}
	};
	draw_answer(p_question.yes, p_question.on_yes);
	ImGui::SameLine();
	draw_answer(p_question.no, p_question.on_no);
	if (p_question.may_cancel) {
		ImGui::SameLine();
		draw_answer("Cancel", [] {});
		is_answered |= ImGui::IsKeyPressed(GLFW_KEY_ESCAPE, false);
	}
	if (is_answered) {
		ImGui::CloseCurrentPopup();
	}
	ImGui::EndPopup();
	return is_answered;
}

} // namespace gnomon
