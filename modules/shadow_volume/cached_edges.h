#pragma once

#include "modules/shadows/silhouette_lists.h"

namespace gnomon {

/// Silhouette edges that compute shaders found, cached while neither the light nor a caster moves.
/// They get memory of their own in the second frame that needs the same, so that what moves
/// shares the frame's.
class CachedEdges {
public:
	/// Reports whether edges are found this frame. p_are_all_drawn: false where words on the GPU
	/// decide which casters are, so that the lists lack those that are not.
	void plan(const ShadowTechnique::Inputs &p_inputs, const SilhouetteCasters &p_casters,
			bool p_are_all_drawn, TechniquePlan &r_plan);
	/// The lists of plan's casters, of which there is one at least. Without a plan nothing is
	/// cached.
	SilhouetteLists add_passes(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
			const SilhouetteCasters &p_casters, const DrawPredicates &p_predicates);

private:
	void reset();

	OwnedBuffer list;
	OwnedBuffer draws;
	uint64_t cached_key = 0; // of what the buffers hold; 0: nothing
	uint64_t last_key = 0;	 // of the last frame

	// This frame.
	uint64_t key = 0; // 0: nothing may be cached
	bool is_cached = false;
	bool is_still = false;
};

} // namespace gnomon
