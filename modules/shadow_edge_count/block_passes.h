#pragma once

#include "modules/render_graph/compute_pass.h"
#include "modules/shadow_edge_count/count_buffers.h"
#include "modules/shadow_edge_count/count_rounds.h"

namespace gnomon {

/// The inputs of the passes over an image's pixels.
struct CountBlockPasses {
	const ShadowTechnique::Inputs &inputs;
	const CountSettings &settings;
	CountFrameBuffers light; // the light's faces, edges and face lists
	CountCapacities capacities;
	uint32_t empty_views = 0; // bit i: view i has no casters or no receivers
	RGBuffer masks;			  // mask tables of all sample sets, see DiscMasks
	/// Depth maps of the views. Empty if no block can have more edges than the budget.
	RGTexture depth_map;
	std::vector<LightView> depth_views; // the views of depth_map
};

/// Results of add_block_passes: edge lists of the blocks of pixels, and lists of blocks by kind.
struct CountBlocks {
	std::vector<PassBinding> receivers; // from make_map_resolve_bindings
	RGBuffer constants;					// CountLightConstants
	RGBuffer block_receivers;			// per block, EDGE_COUNT_RECEIVERS_*
	RGBuffer chains;					// per block and part, EDGE_COUNT_CHAIN_*
	RGBuffer lists;						// chunks of edges, see EDGE_COUNT_CHUNK_SIZE
	RGBuffer blocks;					// a list of blocks for each kind, EDGE_COUNT_BLOCKS_*
	RGBuffer dispatches;				// indirect dispatch arguments for each kind
	RGBuffer status;					// EDGE_COUNT_STATUS_*, see count_status.h
	CountRounds rounds;					// for subgroups with very many edges
	uint32_t block_count = 0;
};

/// The light's constants for passes over views and pixels. p_empty_views: bit i is set if view i
/// has no casters or no receivers.
shader::CountLightConstants make_block_constants(const ShadowTechnique::Inputs &p_inputs,
		const CountSettings &p_settings, const CountCapacities &p_capacities,
		uint32_t p_empty_views);

/// Adds passes that find the bounds of each block's receivers and list its edges.
CountBlocks add_block_passes(RenderGraph &r_graph, const CountBlockPasses &p_passes);

/// Adds one pass for each kind of block, for those beyond the budget only if there is a depth map.
/// Returns the mask.
RGTexture add_count_passes(
		RenderGraph &r_graph, const CountBlockPasses &p_passes, const CountBlocks &p_blocks);

/// Adds one pass for each kind of block. Returns a debug image with three array layers: per pixel
/// the number of edges that were counted, the number of solids between its receiver and the light's
/// centre, and its block's kind (EDGE_COUNT_BLOCKS_*).
RGTexture add_count_debug_pass(
		RenderGraph &r_graph, const CountBlockPasses &p_passes, const CountBlocks &p_blocks);

/// Capacity of the edge lists of all blocks together, in chunks of EDGE_COUNT_CHUNK_SIZE edges. At
/// least 1. p_size_px: size of the image. p_edge_count: number of edges of the casters.
uint32_t choose_chunk_capacity(glm::uvec2 p_size_px, uint32_t p_edge_count);

} // namespace gnomon
