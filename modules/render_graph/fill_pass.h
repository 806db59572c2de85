#pragma once

#include "modules/render_graph/render_graph.h"

#include <cstdint>
#include <string>

namespace gnomon {

/// Adds a pass that sets all 32-bit words of a STORAGE buffer to the value. For 0, record
/// CommandList::clear_buffer instead, which needs no shader.
void add_fill_pass(RenderGraph &r_graph, RenderingDevice &p_device, const std::string &p_name,
		RGBuffer p_buffer, uint32_t p_value);

} // namespace gnomon
