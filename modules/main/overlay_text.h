#pragma once

#include "modules/renderer/renderer.h"

#include <string>
#include <vector>

namespace gnomon {

/// Builds triangles for RenderRequest::overlay that show lines of text on a dark panel at the top
/// left of the image. Draws printable ASCII only and skips other bytes. p_scale: image pixels per
/// font pixel; a line is 12 font pixels high.
std::vector<OverlayVertex> make_overlay_text(
		const std::vector<std::string> &p_lines, float p_scale);

} // namespace gnomon
