#pragma once

#include "modules/editor/editor_context.h"

#include <chrono>
#include <filesystem>

namespace gnomon {

/// The session of one opened scene: executes commands, asks for confirmation where needed, and
/// watches the file on disk. It does not draw the scene or the panels.
class EditorSession {
public:
	using Clock = EditorDocument::Clock;

	/// p_program: path of this program's executable.
	EditorSession(EditorContext &r_context, std::filesystem::path p_program);

	/// Moves the viewport's camera to the scene's first camera, or so that the whole scene is
	/// visible.
	void move_to_scene_camera();
	/// Once a second, checks whether another program, such as Blender, has written the file. If so,
	/// reloads it, or opens a dialog if there are unsaved changes.
	void check_file(Clock::time_point p_now);
	/// Executes the command that panels and keys requested in this frame.
	void run_command();
	/// Draws the dialog that needs an answer, if any, and carries the answer out.
	void draw_dialogs();
	/// Starts closing the scene. draw_dialogs completes it, after a dialog if there are unsaved
	/// changes.
	void close() { is_closing = true; }

	/// Whether a dialog is open.
	bool is_prompting() const { return is_closing || prompts_recovery || prompts_reload; }
	bool is_closed() const { return is_done; }
	/// Completes closing without drawing, for a minimised window, if there are no unsaved changes.
	void close_if_unchanged() { is_done |= is_closing && !document.is_changed(); }
	/// Scene to open after this one is closed; empty: none.
	const std::filesystem::path &get_next_path() const { return next_path; }

private:
	void run(EditorCommand p_command);
	std::string describe_staged() const;
	void open_page();
	void recover();
	struct Dialog;
	bool draw_dialog(const Dialog &p_dialog);
	Dialog make_closing_dialog();

	EditorContext &context;
	EditorDocument &document;
	std::filesystem::path program; // this program's executable
	Clock::time_point next_file_check;
	std::filesystem::path next_path;
	bool prompts_recovery = false;
	bool prompts_reload = false;
	bool is_closing = false;
	bool is_done = false;
};

} // namespace gnomon
