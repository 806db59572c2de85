#pragma once

#include "modules/editor/editor_context.h"

#include <chrono>
#include <filesystem>

namespace gnomon {

/// Executes commands of keys and buttons, asks for confirmation where needed, and watches the file
/// on disk: everything between opening and closing a scene except drawing.
class EditorSession {
public:
	using Clock = EditorDocument::Clock;

	/// p_program: path of this program's executable.
	EditorSession(EditorContext &r_context, std::filesystem::path p_program);

	/// Moves the viewport's camera to the scene's first camera, or so that the whole scene is
	/// visible.
	void look_as_scene();
	/// Checks whether another program, such as Blender, has written the file.
	void follow_file(Clock::time_point p_now);
	/// Executes the command that panels and keys requested in this frame.
	void run_command();
	void draw_questions();
	/// Starts closing; prompts for unsaved changes if needed.
	void close() { is_closing = true; }

	bool is_prompting() const { return is_closing || prompts_recovery || prompts_reload; }
	bool is_closed() const { return is_done; }
	/// For a window that is not visible: closes if no prompt is needed.
	void close_unseen() { is_done |= is_closing && !document.is_changed(); }
	/// Scene to open after this one is closed; empty: none.
	const std::filesystem::path &get_next_path() const { return next_path; }

private:
	void run(EditorCommand p_command);
	std::string describe_staged() const;
	void read_page();
	void recover();
	struct Question;
	bool draw_question(const Question &p_question);
	Question make_closing_question();

	EditorContext &context;
	EditorDocument &document;
	std::filesystem::path program;
	Clock::time_point next_file_check;
	std::filesystem::path next_path;
	bool prompts_recovery = false;
	bool prompts_reload = false;
	bool is_closing = false;
	bool is_done = false;
};

} // namespace gnomon
