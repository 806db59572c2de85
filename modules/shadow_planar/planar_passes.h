#pragma once

#include "modules/shadow_planar/receiver_planes.h"
#include "modules/shadows/shadow_technique.h"

namespace gnomon {

/// What shadows are drawn into: a mask, R16_SFLOAT, and a stencil that marks where the plane in
/// hand is seen and not yet dark.
struct PlanarTargets {
	RGTexture mask;
	RGTexture stencil; // D32_SFLOAT_S8_UINT; its depth is not used
};

/// Makes the targets; the mask is 1 at receivers and 0 elsewhere.
PlanarTargets add_lit_pass(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs);

/// Passes that darken what the casters (instances) hide of one plane.
void add_plane_passes(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
		const ReceiverPlane &p_plane, uint32_t p_plane_index,
		const std::vector<uint32_t> &p_casters, const PlanarTargets &p_targets);

} // namespace gnomon
