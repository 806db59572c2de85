#pragma once

#include "modules/editor/editor_context.h"

#include <chrono>
#include <filesystem>

namespace gnomon {

/// Does what keys and buttons request, asks what must be answered first, and follows the file on
/// disk: all between opening a scene and closing it that is not drawing.
class EditorSession {
public:
	using Clock = EditorDocument::Clock;

	/// p_program: this program's file.
	EditorSession(EditorContext &r_context, std::filesystem::path p_program);

	/// The camera as the scene's first, or so that all of it is seen.
	void look_as_scene();
	/// Another program, such as Blender, may have written the file.
	void follow_file(Clock::time_point p_now);
	/// What the panels and keys of this frame have requested.
	void run_command();
	void draw_questions();
	/// Prompts for what is to become of changes, if need be.
	void close() { is_closing = true; }

	bool is_prompting() const { return is_closing || prompts_recovery || prompts_reload; }
	bool is_closed() const { return is_done; }
	/// Of a window that cannot be seen: closes if there is no question.
	void close_unseen() { is_done |= is_closing && !document.is_changed(); }
	/// To be opened once this one is closed; empty: nothing.
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
