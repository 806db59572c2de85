#pragma once

#include "modules/render_graph/render_graph.h"

#include <functional>
#include <optional>

namespace gnomon {

/// Presents the image (SAMPLED; stored values are copied) in the window whose next image p_acquire
/// returns, see RenderGraph::import_window_image: stretched to the window, nearest texel.
void add_present_pass(RenderGraph &r_graph, RGTexture p_image,
		std::function<std::optional<TextureRID>()> p_acquire);

} // namespace gnomon
