#pragma once

#include "modules/render_graph/render_graph.h"

#include <cstdint>
#include <vector>

namespace gnomon {

/// Copies a texture's layer into a buffer that the CPU can read, rows from the top, tightly
/// packed; for a host pass. Not with a stencil.
RGBuffer add_copy_for_host(RenderGraph &r_graph, RGTexture p_texture, uint32_t p_layer = 0);

/// Like add_copy_for_host; r_bytes receives the data when the graph is executed and must live until
/// then.
void add_readback(RenderGraph &r_graph, RGTexture p_texture, std::vector<uint8_t> &r_bytes,
		uint32_t p_layer = 0);

} // namespace gnomon
