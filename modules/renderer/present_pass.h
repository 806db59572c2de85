#pragma once

#include "modules/render_graph/render_graph.h"

#include <functional>
#include <optional>

namespace gnomon {

/// Adds a pass that copies the image (usage SAMPLED) to the window's next image, which p_acquire
/// returns, see RenderGraph::import_window_image. The image is stretched to the window with nearest
/// sampling; stored values are not converted.
void add_present_pass(RenderGraph &r_graph, RGTexture p_image,
		std::function<std::optional<TextureRID>()> p_acquire);

} // namespace gnomon
