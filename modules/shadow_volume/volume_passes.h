#pragma once

#include "modules/shadow_volume/cached_edges.h"
#include "modules/shadow_volume/volume_casters.h"

namespace gnomon {

/// What volumes are counted in. The mask is R16_SFLOAT.
struct VolumeTargets {
	RGTexture mask;
	RGTexture depth; // D32_SFLOAT_S8_UINT: of the receivers moved off their surfaces; the count
};

/// Makes the targets: a mask that is 1 at receivers and 0 elsewhere, and no count.
VolumeTargets add_volume_receivers_pass(
		RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs);

/// Those whose edges compute shaders find.
SilhouetteCasters list_compute_casters(
		const ShadowTechnique::Inputs &p_inputs, const VolumeCasters &p_casters);

/// Counts the volumes of each group, of casters whose predicate is not 0, and darkens the mask
/// where the count is not 0. p_casters must stay until the frame has run.
void add_volume_passes(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
		const VolumeSettings &p_settings, const VolumeCasters &p_casters,
		const DrawPredicates &p_predicates, const VolumeTargets &p_targets, CachedEdges &r_edges);

} // namespace gnomon
