#pragma once

#include "modules/render_graph/render_graph.h"

#include <functional>
#include <optional>

namespace gnomon {

/// Shows the image (SAMPLED, values as they are stored) in the window whose next image p_acquire
/// gives, see RenderGraph::import_window_image: stretched over it, nearest texel.
void add_present_pass(RenderGraph &r_graph, RGTexture p_image,
		std::function<std::optional<TextureRID>()> p_acquire);

} // namespace gnomon
