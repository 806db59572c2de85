#pragma once

#include "modules/shadows/silhouette_lists.h"

namespace gnomon {

/// Silhouette edges found by compute shaders, cached while neither the light nor a caster moves.
/// They get persistent memory in the second consecutive frame that needs the same edges; until then
/// they use transient memory of the frame.
class CachedEdges {
public:
	/// Reports in the plan whether edges are found this frame. p_are_all_drawn: false when
	/// predicates on the GPU select the casters, so that the lists may be incomplete.
	void plan(const ShadowTechnique::Inputs &p_inputs, const SilhouetteCasters &p_casters,
			bool p_are_all_drawn, TechniquePlan &r_plan);
	/// Returns the lists of the casters that were planned, at least one. Without a call of plan
	/// nothing is cached.
	SilhouetteLists add_passes(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
			const SilhouetteCasters &p_casters, const DrawPredicates &p_predicates);

private:
	void reset();

	OwnedBuffer list;
	OwnedBuffer draws;
	uint64_t cached_key = 0; // key of the buffers' content; 0: nothing
	uint64_t last_key = 0;	 // key of the last frame

	// This frame.
	uint64_t key = 0; // 0: nothing may be cached
	bool is_cached = false;
	bool is_still = false;
};

} // namespace gnomon
