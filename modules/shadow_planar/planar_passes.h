#pragma once

#include "modules/shadow_planar/receiver_planes.h"
#include "modules/shadows/shadow_technique.h"

namespace gnomon {

/// The targets of planar shadows: a mask, R16_SFLOAT, and a stencil that marks the pixels of the
/// current plane that are not in shadow yet.
struct PlanarTargets {
	RGTexture mask;
	RGTexture stencil; // D32_SFLOAT_S8_UINT; its depth is not used
};

/// Creates the targets, and adds the pass that sets the mask to 1 at receivers and 0 elsewhere.
PlanarTargets add_lit_pass(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs);

/// Adds the passes that set the mask to 0 where casters hide one plane from the light. p_casters:
/// instance indices. p_plane_index: for the passes' names.
void add_plane_passes(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
		const ReceiverPlane &p_plane, uint32_t p_plane_index,
		const std::vector<uint32_t> &p_casters, const PlanarTargets &p_targets);

} // namespace gnomon
