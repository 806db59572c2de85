#pragma once

#include "modules/render_graph/compute_pass.h"
#include "modules/shadow_edge_count/count_buffers.h"

namespace gnomon {

/// What the passes over a picture's pixels need, and what they make for one another.
struct CountBlockPasses {
	const ShadowTechnique::Inputs &inputs;
	const CountSettings &settings;
	CountFrameBuffers light;
	CountCapacities capacities;
	uint32_t empty_views = 0; // bit i: view i has no casters
	RGBuffer masks;			  // the tables of DiscMasks, one per turn
	/// Blocks may have more edges than a list holds, or the light's buffers less room than needed.
	bool may_be_over = true;
};

/// Lists of edges, one per block of pixels.
struct CountBlocks {
	std::vector<PassBinding> receivers; // make_map_resolve_bindings
	RGBuffer constants;					// CountLightConstants
	RGBuffer ends;						// of each block's list in `lists`, per view
	RGBuffer lists;
	RGBuffer blocks;	 // by kind, EDGE_COUNT_BLOCKS_*
	RGBuffer dispatches; // see EDGE_COUNT_BLOCK_KINDS
	uint32_t block_count = 0;
};

/// Passes that find the bounds of each group's receivers and each block's edges.
CountBlocks add_block_passes(RenderGraph &r_graph, const CountBlockPasses &p_passes);

/// The passes over blocks without edges and with them; then, where blocks may be over budget, those
/// that filter in them. Returns the mask.
RGTexture add_count_passes(
		RenderGraph &r_graph, const CountBlockPasses &p_passes, const CountBlocks &p_blocks);

/// Three layers: edges that were counted per pixel, solids at its reference texel, and its block's
/// kind.
RGTexture add_count_debug_pass(
		RenderGraph &r_graph, const CountBlockPasses &p_passes, const CountBlocks &p_blocks);

/// Groups of 8 x 8 pixels along a block's side: such that all lists stay below 34 MB.
uint32_t choose_groups_per_block_side(glm::uvec2 p_size_px, uint32_t p_budget);
/// Edges that a block's list holds: the property's, or, where that is the default or more, as many
/// of the scene's as fit into the same memory; the blocks of a small picture are few, and have
/// many.
uint32_t choose_budget(glm::uvec2 p_size_px, uint32_t p_budget, uint64_t p_edge_count);

} // namespace gnomon
