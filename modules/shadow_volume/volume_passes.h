#pragma once

#include "modules/shadow_volume/cached_edges.h"
#include "modules/shadow_volume/volume_casters.h"

namespace gnomon {

/// The attachments of the volume passes. The mask is R16_SFLOAT.
struct VolumeTargets {
	RGTexture mask;
	/// D32_SFLOAT_S8_UINT. Depth: receivers, moved off their surfaces. Stencil: the volumes' count.
	RGTexture depth;
};

/// Creates the targets and adds a pass that initialises them: the mask is 1 at receivers and 0
/// elsewhere, the stencil is 0.
VolumeTargets add_volume_receivers_pass(
		RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs);

/// Returns the casters whose silhouette edges are found by compute shaders.
SilhouetteCasters list_compute_casters(
		const ShadowTechnique::Inputs &p_inputs, const VolumeCasters &p_casters);

/// Adds passes that count the volumes of each group, for casters whose predicate is not 0, and set
/// the mask to 0 where the count is not 0. The passes refer to p_casters: it must live until the
/// graph has been executed.
void add_volume_passes(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
		const VolumeSettings &p_settings, const VolumeCasters &p_casters,
		const DrawPredicates &p_predicates, const VolumeTargets &p_targets, CachedEdges &r_edges);

} // namespace gnomon
