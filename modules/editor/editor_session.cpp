#include "modules/editor/editor_session.h"

#include "modules/core/error.h"
#include "modules/core/project.h"
#include "modules/core/text.h"
#include "modules/editor/child_process.h"
#include "modules/scene/node_properties.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <functional>

namespace gnomon {

namespace {

const std::chrono::seconds FILE_CHECK_INTERVAL{ 1 };
const double DEFAULT_PIVOT_DISTANCE_M = 5.0; // for a scene without casters

} // namespace

/// A modal dialog with two answers.
struct EditorSession::Dialog {
	const char *title = "";
	std::string text;
	const char *yes = "";
	const char *no = "";
	std::function<void()> on_yes;
	std::function<void()> on_no;
	bool may_cancel = false; // adds a Cancel button, and Escape cancels; neither runs an action
};

/// Draws the dialog over all panels. Returns true once the user has answered and the answer's
/// action has run.
bool EditorSession::draw_dialog(const Dialog &p_dialog) {
	ImGui::OpenPopup(p_dialog.title);
	if (!ImGui::BeginPopupModal(p_dialog.title, nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
		return false;
	}
	ImGui::TextUnformatted(p_dialog.text.c_str());
	bool is_answered = false;
	const auto draw_answer = [&](const char *p_label, const std::function<void()> &p_action) {
		const bool is_pressed = ImGui::Button(p_label);
		context.record_item_rect(std::string("button ") + p_label);
		if (is_pressed) {
			p_action();
			is_answered = true;
		}
	};
	draw_answer(p_dialog.yes, p_dialog.on_yes);
	ImGui::SameLine();
	draw_answer(p_dialog.no, p_dialog.on_no);
	if (p_dialog.may_cancel) {
		ImGui::SameLine();
		draw_answer("Cancel", [] {});
		is_answered |= ImGui::IsKeyPressed(GLFW_KEY_ESCAPE, /*repeat=*/false);
	}
	if (is_answered) {
		ImGui::CloseCurrentPopup();
	}
	ImGui::EndPopup();
	return is_answered;
}

EditorSession::EditorSession(EditorContext &r_context, std::filesystem::path p_program) :
		context(r_context), document(r_context.document), program(std::move(p_program)),
		prompts_recovery(r_context.document.has_recovery()) {}

void EditorSession::move_to_scene_camera() {
	const std::vector<Camera3D *> cameras = document.get_scene().find_nodes<Camera3D>();
	Bounds bounds;
	context.attempt([&] { bounds = document.compute_selected_bounds(); });
	if (cameras.empty()) {
		context.viewport.camera.frame(bounds);
		return;
	}
	const glm::dvec3 position(cameras.front()->compute_world_from_node()[3]);
	const double distance_m = bounds.is_empty()
			? DEFAULT_PIVOT_DISTANCE_M
			: glm::length(0.5 * (bounds.minimum + bounds.maximum) - position);
	context.viewport.camera.move_to_camera(*cameras.front(), distance_m);
}

void EditorSession::check_file(Clock::time_point p_now) {
	if (p_now < next_file_check) {
		return;
	}
	next_file_check = p_now + FILE_CHECK_INTERVAL;
	if (!document.is_file_newer() || document.is_changed()) {
		prompts_reload |= document.is_file_newer();
		return;
	}
	context.attempt([&] {
		const bool was_read = document.get_failure().empty();
		document.reload();
		if (!was_read) {
			move_to_scene_camera();
		}
		context.set_status("The file has changed and was reloaded.");
	});
}

void EditorSession::run_command() {
	const EditorCommand command = std::exchange(context.command, EditorCommand::NONE);
	if (command == EditorCommand::NONE) {
		return;
	}
	context.attempt([&] { run(command); });
}

void EditorSession::run(EditorCommand p_command) {
	const bool saves = p_command == EditorCommand::SAVE ||
			(p_command == EditorCommand::PLAY && document.is_changed());
	if (saves && document.is_file_newer()) {
		prompts_reload = true;
		return;
	}
	Node3D *selected = document.get_selected();
	switch (p_command) {
		case EditorCommand::NONE:
			break;
		case EditorCommand::SHOW_OPEN_MENU:
			context.shows_open_menu = true;
			break;
		case EditorCommand::OPEN:
			next_path = find_project_scene(context.open_path).scene_path;
			if (!std::filesystem::exists(next_path)) {
				// Clears next_path, so that closing the editor later does not open it.
				fail("Scene ", std::exchange(next_path, {}), " does not exist. Check the path.");
			}
			is_closing = true;
			break;
		case EditorCommand::SAVE:
			document.save();
			context.set_status(text(
					"Saved ", document.get_path().filename().string(), ".", describe_staged()));
			break;
		case EditorCommand::UNDO:
			if (const std::string name = document.undo(); !name.empty()) {
				context.set_status("Undone: " + name);
			}
			break;
		case EditorCommand::REDO:
			if (const std::string name = document.redo(); !name.empty()) {
				context.set_status("Redone: " + name);
			}
			break;
		case EditorCommand::DUPLICATE:
			if (selected != nullptr) {
				document.duplicate(*selected);
			}
			break;
		case EditorCommand::DELETE:
			if (selected != nullptr) {
				document.remove(*selected);
			}
			break;
		case EditorCommand::FRAME:
			context.viewport.camera.frame(document.compute_selected_bounds());
			break;
		case EditorCommand::PLAY:
			if (document.is_changed()) {
				document.save();
			}
			start_program({ program.string(), "run", document.get_path().string(), "--stage",
					get_stage_mode_name(document.get_stage()) });
			context.set_status(text("The game runs in its own window.", describe_staged()));
			break;
		case EditorCommand::PLAY_ANIMATION:
			if (Timeline &timeline = document.get_timeline(); timeline.is_playing()) {
				timeline.pause();
			} else {
				timeline.play();
				context.viewport.is_moving = timeline.is_playing();
			}
			break;
		case EditorCommand::OPEN_PAGE:
			open_page();
			break;
		case EditorCommand::QUIT:
			is_closing = true;
			break;
	}
}

/// Returns a sentence that lists the staged nodes, which saving skips even if they were changed;
/// empty if there are none.
std::string EditorSession::describe_staged() const {
	const std::string names = document.list_staged();
	return names.empty() ? "" : " Never saved while staged: " + names + ".";
}

/// Opens context.requested_page with the desktop's default program.
void EditorSession::open_page() {
	const std::filesystem::path page = program.parent_path().parent_path() / context.requested_page;
	if (!std::filesystem::exists(page)) {
		fail("Page ", page,
				" does not exist. Run bin/gnomon of the source tree, which contains the pages.");
	}
	start_program({ "xdg-open", page.string() });
	context.set_status(text("Opened ", page.string()));
}

void EditorSession::recover() {
	context.attempt([&] {
		const bool was_read = document.get_failure().empty();
		document.recover();
		if (!was_read) {
			move_to_scene_camera();
		}
	});
}

void EditorSession::draw_dialogs() {
	if (is_closing && !document.is_changed()) {
		is_done = true;
	} else if (is_closing) {
		is_closing = !draw_dialog(make_closing_dialog());
		if (!is_closing && !is_done) {
			next_path.clear(); // cancelled, or saving failed
		}
	} else if (prompts_recovery) {
		prompts_recovery = !draw_dialog({ "Recover changes?",
				"The editor ended without saving. The changes are in a recovery file.", "Recover",
				"Discard", [&] { recover(); }, [&] { document.discard_recovery(); } });
	} else if (prompts_reload) {
		prompts_reload = !draw_dialog({ "Reload the file?",
				"Another program has changed the file, and this scene has unsaved changes.",
				"Reload, discard the changes", "Keep the changes",
				[&] { context.attempt([&] { document.reload(); }); },
				[&] { document.ignore_newer_file(); } });
	}
}

EditorSession::Dialog EditorSession::make_closing_dialog() {
	const auto save = [&] {
		if (document.is_file_newer()) {
			prompts_reload = true; // first, the user chooses which version to keep
			return;
		}
		context.attempt([&] {
			document.save();
			is_done = true;
		});
	};
	const auto close_without_saving = [&] {
		document.discard_own_recovery();
		is_done = true;
	};
	return { "Save the changes?",
		text(document.get_path().filename().string(), " has changes that are not saved.",
				describe_staged()),
		"Save and close", "Close without saving", save, close_without_saving,
		/*may_cancel=*/true };
}

} // namespace gnomon
