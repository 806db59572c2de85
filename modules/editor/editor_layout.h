#pragma once

#include "modules/editor/editor_context.h"
#include "modules/editor/editor_settings.h"

namespace gnomon {

/// All panels, over the whole window.
void draw_layout(EditorContext &r_context, EditorLayout &r_layout);

} // namespace gnomon
