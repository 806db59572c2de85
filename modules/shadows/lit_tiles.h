#pragma once

#include "modules/render_graph/compute_pass.h"

#include <cstdint>
#include <string>
#include <vector>

namespace gnomon {

/// The tiles of 16 x 16 pixels that may contain receivers of one light, found on the GPU from the
/// depths in each tile and the light's range and cone. Passes of the light that dispatch only these
/// tiles cost what the light's pixels cost.
struct LitTiles {
	RGBuffer tiles;		// LIT_TILES_COUNT and LIT_TILES_FIRST of shared/lit_tiles_shared.h
	RGBuffer arguments; // of indirect dispatches: LIT_TILES_*_ARGUMENTS
};

/// The work groups of a pass over tiles; how its shader finds its pixels is in
/// common/lit_tiles_inc.glsl.
enum class TileDispatch {
	BLOCKS, // one for each 8 x 8 pixels
	TILES,	// one for each tile
};

/// Adds a pass that finds the range of depths in each tile, for all lights.
RGBuffer add_tile_depths_pass(RenderGraph &r_graph, RenderingDevice &p_device, RGBuffer p_frame,
		RGTexture p_depth, glm::uvec2 p_size_px);
/// Adds the passes that list a light's tiles. p_lists_all: all tiles of the image.
LitTiles add_lit_tiles_pass(RenderGraph &r_graph, RenderingDevice &p_device, RGBuffer p_frame,
		RGBuffer p_light_constants, RGBuffer p_tile_depths, glm::uvec2 p_size_px, bool p_lists_all);

/// Adds a compute pass over a light's tiles. p_tiles_binding: LIT_TILES_BINDING of the shader.
void add_tile_pass(RenderGraph &r_graph, const std::string &p_name, PipelineRID p_pipeline,
		std::vector<PassBinding> p_bindings, const LitTiles &p_tiles, uint32_t p_tiles_binding,
		std::vector<uint8_t> p_push = {}, TileDispatch p_dispatch = TileDispatch::BLOCKS);

} // namespace gnomon
