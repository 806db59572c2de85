#pragma once

#include "modules/renderer/renderer.h"

#include <string>
#include <vector>

namespace gnomon {

/// Makes lines of text on a dark panel at the top left, as triangles for RenderRequest::overlay.
/// ASCII only; other bytes are skipped. p_scale: pixels per font pixel; a line is 12 font pixels
/// high.
std::vector<OverlayVertex> make_overlay_text(
		const std::vector<std::string> &p_lines, float p_scale);

} // namespace gnomon
