#pragma once

#include "modules/render_graph/compute_pass.h"
#include "modules/shadow_edge_count/count_buffers.h"
#include "modules/shadow_edge_count/count_rounds.h"

namespace gnomon {

/// The inputs of the passes over an image's pixels.
struct CountLeafPasses {
	const ShadowTechnique::Inputs &inputs;
	const CountSettings &settings;
	CountFrameBuffers light; // the light's faces, edges and trees
	CountCapacities capacities;
	uint32_t empty_views = 0; // bit i: view i has no casters or no receivers
	RGBuffer masks;			  // mask tables of all sample sets, see DiscMasks
	RGBuffer few_masks;		  // with a time budget: of 64 points; else empty
	/// With a time budget: the position of its ladder in the frame before, and the cost for which
	/// there is time, see EDGE_COUNT_RUNG_FULL.
	RGBuffer ladder;
	uint32_t cost_limit = EDGE_COUNT_NO_COST_LIMIT;
	/// Depth maps of the views. Empty if no leaf can have more edges than the budget.
	RGTexture depth_map;
};

/// Results of add_leaf_passes: the leaves, their lists, and which leaves are of which kind.
struct CountLeaves {
	std::vector<PassBinding> receivers; // from make_map_resolve_bindings
	RGBuffer constants;					// CountLightConstants
	RGBuffer leaves;					// CountLeaf
	RGBuffer results;					// CountLeafResult
	RGBuffer lists;						// words, see CountLeafResult
	RGBuffer kinds;						// the leaves of each kind, EDGE_COUNT_LEAVES_*
	RGBuffer arguments;					// of the dispatch for each kind
	RGBuffer counts;					// EDGE_COUNT_COUNT_*
	RGBuffer status;					// EDGE_COUNT_STATUS_*, see count_status.h
	CountRounds rounds;					// for subgroups with very many edges
	uint32_t leaf_capacity = 0;
	uint32_t chunk_count = 1; // see CountLeafPush
};

/// The light's constants for all passes. p_empty_views: bit i is set if view i has no casters or no
/// receivers.
shader::CountLightConstants make_leaf_constants(const ShadowTechnique::Inputs &p_inputs,
		const CountSettings &p_settings, const CountCapacities &p_capacities,
		uint32_t p_empty_views);

/// Adds passes that divide the receivers into leaves and list their edges.
CountLeaves add_leaf_passes(RenderGraph &r_graph, const CountLeafPasses &p_passes);

/// Adds one pass for each kind of leaf, for those beyond the budget only if there is a depth map.
/// Returns the mask.
RGTexture add_count_passes(
		RenderGraph &r_graph, const CountLeafPasses &p_passes, const CountLeaves &p_leaves);

/// Adds one pass for each kind of leaf. Returns a debug image with three array layers: per pixel
/// the number of edges that were counted, the number of solids between its receiver and the light's
/// centre, and its leaf's kind (EDGE_COUNT_LEAVES_*).
RGTexture add_count_debug_pass(
		RenderGraph &r_graph, const CountLeafPasses &p_passes, const CountLeaves &p_leaves);

/// Capacity of the lists of all leaves together, in words. At least 1. p_size_px: size of the
/// image. p_item_count: number of faces and edges of the casters.
uint32_t choose_list_capacity(glm::uvec2 p_size_px, uint32_t p_item_count);

} // namespace gnomon
