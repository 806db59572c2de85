#include "modules/editor/editor_keys.h"

#include <GLFW/glfw3.h>

namespace gnomon {

EditorCommand find_command(const Window::KeyPress &p_press) {
	const bool has_control = (p_press.modifiers & GLFW_MOD_CONTROL) != 0;
	const bool has_shift = (p_press.modifiers & GLFW_MOD_SHIFT) != 0;
	switch (p_press.key) {
		case GLFW_KEY_O:
			return has_control ? EditorCommand::ASK_TO_OPEN : EditorCommand::NONE;
		case GLFW_KEY_S:
			return has_control ? EditorCommand::SAVE : EditorCommand::NONE;
		case GLFW_KEY_Z:
			return !has_control ? EditorCommand::NONE
					: has_shift ? EditorCommand::REDO
								: EditorCommand::UNDO;
		case GLFW_KEY_Y:
			return has_control ? EditorCommand::REDO : EditorCommand::NONE;
		case GLFW_KEY_D:
			return has_control ? EditorCommand::DUPLICATE : EditorCommand::NONE;
		case GLFW_KEY_F:
			return has_control ? EditorCommand::NONE : EditorCommand::FRAME;
		case GLFW_KEY_DELETE:
			return EditorCommand::DELETE;
		case GLFW_KEY_F5:
			return EditorCommand::PLAY;
		case GLFW_KEY_Q:
			return has_control ? EditorCommand::QUIT : EditorCommand::NONE;
		default:
			return EditorCommand::NONE;
	}
}

} // namespace gnomon
