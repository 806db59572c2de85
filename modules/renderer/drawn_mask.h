#pragma once

#include "modules/render_graph/render_graph.h"

// For techniques that draw their mask with a stencil, in place of computing it.

namespace gnomon {

/// A mask that is drawn into: R16_SFLOAT.
RGTexture create_drawn_mask(RenderGraph &r_graph, glm::uvec2 p_size_px);
/// A D32_SFLOAT_S8_UINT target.
RGTexture create_stencil_target(
		RenderGraph &r_graph, const std::string &p_name, glm::uvec2 p_size_px);

/// A pipeline that draws one triangle over all of the picture into those two, and changes neither
/// depth nor stencil. p_fragment_shader: what it writes. To be completed: the stencil.
RasterPipelineDesc make_screen_desc(
		const std::string &p_name, const std::string &p_fragment_shader);

} // namespace gnomon
