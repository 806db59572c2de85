#pragma once

#include "modules/render_graph/render_graph.h"

#include <cstdint>
#include <vector>

namespace gnomon {

/// Adds a pass that copies a texture's layer into a READBACK buffer, which a host pass can read.
/// Rows are tightly packed and start at the top. Formats with a stencil are not supported.
RGBuffer add_copy_for_host(RenderGraph &r_graph, RGTexture p_texture, uint32_t p_layer = 0);

/// Adds the same pass, and a host pass that copies the data to r_bytes. r_bytes must live until the
/// graph has been executed.
void add_readback(RenderGraph &r_graph, RGTexture p_texture, std::vector<uint8_t> &r_bytes,
		uint32_t p_layer = 0);

} // namespace gnomon
