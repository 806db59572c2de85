#pragma once

#include "modules/render_graph/render_graph.h"

#include <cstdint>
#include <string>

namespace gnomon {

/// Adds a pass that sets all 32-bit words of a STORAGE buffer to the value. For 0, record
/// CommandList::clear_buffer instead, which needs no shader.
void add_fill_pass(RenderGraph &r_graph, RenderingDevice &p_device, const std::string &p_name,
		RGBuffer p_buffer, uint32_t p_value);

/// Adds a pass that sets all texels of a colour texture with usage COPY_TARGET to the value, of one
/// layer or of all.
void add_clear_pass(RenderGraph &r_graph, const std::string &p_name, RGTexture p_texture,
		float p_value, uint32_t p_layer = Binding::ALL_LAYERS);

} // namespace gnomon
