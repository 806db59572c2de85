#pragma once

#include "modules/editor/editor_context.h"

namespace gnomon {

/// Where the panels stand: shares of the window, which the lines between them change.
struct EditorLayout {
	float left = 0.18f;	  // the scene tree's width
	float right = 0.31f;  // the inspector's
	float bottom = 0.30f; // height of error, plan and modules
};

/// All panels, over the whole window.
void draw_layout(EditorContext &r_context, EditorLayout &r_layout);

} // namespace gnomon
