#pragma once

#include "modules/editor/editor_context.h"

#include <functional>
#include <string>

namespace gnomon {

/// Something that must be answered before all else.
struct EditorQuestion {
	const char *title = "";
	std::string text;
	const char *yes = "";
	const char *no = "";
	std::function<void()> on_yes;
	std::function<void()> on_no;
	bool may_cancel = false; // Escape and a third button: as if it had not been asked
};

/// Draws the question over everything. True once it is answered; the answer was done then.
bool draw_question(EditorContext &r_context, const EditorQuestion &p_question);

} // namespace gnomon
