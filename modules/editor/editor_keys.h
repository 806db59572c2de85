#pragma once

#include "modules/desktop/window.h"
#include "modules/editor/editor_context.h"

namespace gnomon {

/// What a key asks for, as in Godot and Blender; see doc/editor.md.
EditorCommand find_command(const Window::KeyPress &p_press);

} // namespace gnomon
