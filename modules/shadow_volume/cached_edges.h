#pragma once

#include "modules/shadows/silhouette_lists.h"

namespace gnomon {

/// Silhouette edges found by compute shaders, cached while neither the light nor a caster moves.
/// They get persistent memory in the second consecutive frame that needs the same edges; until then
/// they use transient memory of the frame.
class CachedEdges {
public:
	/// Decides whether this frame searches edges or reuses cached ones, and reports that in the
	/// plan. p_are_all_drawn: false when predicates on the GPU select the casters; the lists may
	/// then be incomplete and are not cached.
	void plan(const ShadowTechnique::Inputs &p_inputs, const SilhouetteCasters &p_casters,
			bool p_are_all_drawn, TechniquePlan &r_plan);
	/// Returns the edge lists of p_casters, which must not be empty and must be the casters that
	/// were passed to plan. If plan was not called, the edges are searched and not cached.
	SilhouetteLists add_passes(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
			const SilhouetteCasters &p_casters, const DrawPredicates &p_predicates);

private:
	void reset();

	OwnedBuffer list;
	OwnedBuffer draws;
	uint64_t cached_key = 0; // key of the buffers' content; 0: nothing
	uint64_t last_key = 0;	 // key of the last frame

	// State of the current frame.
	uint64_t key = 0;		   // 0: nothing may be cached
	bool is_cached = false;	   // the buffers hold the edges of `key`
	bool is_unchanged = false; // `key` is the same as in the last frame
};

} // namespace gnomon
