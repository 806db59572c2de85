#pragma once

#include "modules/shadow_penumbra_fins/fins_settings.h"
#include "modules/shadows/shadow_technique.h"

#include <span>

namespace gnomon {

/// Passes that find the nearest layers of one light view's casters (depth peeling, Everitt 2001):
/// p_layers[k] gets, in its texture layer p_view_index, the k-th nearest depth of each texel, all
/// of them different; 0 where there is none. Reversed depth. D32_SFLOAT arrays, one per depth
/// layer, with the usages DEPTH_ATTACHMENT, SAMPLED and, for ONE_PASS, COPY_TARGET.
///
/// Where no caster is closed, a third layer behind an empty second one is not drawn: the peel
/// before sets a flag, on the GPU.
void add_layer_passes(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
		uint32_t p_view_index, std::span<const RGTexture> p_layers, Peeling p_peeling,
		RGBuffer &r_texels);

/// When peels run one after the other: layer 3 is drawn only where layer 2 holds anything, which
/// the GPU finds out. Not for views in which layer 2 holds something for certain.
bool is_layer_3_conditional(const ShadowTechnique::Inputs &p_inputs, uint32_t p_view_index);

} // namespace gnomon
