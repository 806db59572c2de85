#pragma once

#include "modules/shadow_penumbra_fins/fins_settings.h"
#include "modules/shadows/shadow_technique.h"

#include <span>

namespace gnomon {

/// Adds passes that find the nearest depth layers of one light view's casters (depth peeling,
/// Everitt 2001). For each texel, array layer p_view_index of p_layers[k] receives the reversed
/// depth of the nearest surface (k = 0) or of the k-th distinct one behind it; 0 when there is
/// none. p_layers: 1 to 3 D32_SFLOAT texture arrays, one per depth layer, with the usages
/// DEPTH_ATTACHMENT, SAMPLED and, for ONE_PASS, COPY_TARGET.
///
/// With Peeling::PASSES, the third layer is not drawn if no caster is closed and the second layer
/// is empty: the second peel sets a flag on the GPU when it draws something, and the third peel
/// runs only if it is set. See is_layer_3_conditional.
///
/// r_texels: storage buffer of ONE_PASS with more than one layer, unused otherwise. It is created
/// when empty, and all views of a light share it.
void add_layer_passes(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
		uint32_t p_view_index, std::span<const RGTexture> p_layers, Peeling p_peeling,
		RGBuffer &r_texels);

/// With Peeling::PASSES and three layers: true when the GPU decides whether layer 3 is drawn,
/// depending on whether layer 2 is empty. False for views with a closed caster (layer 2 is then
/// not empty), when nothing may be skipped, and on devices without conditional rendering or stores
/// in fragment shaders.
bool is_layer_3_conditional(const ShadowTechnique::Inputs &p_inputs, uint32_t p_view_index);

} // namespace gnomon
