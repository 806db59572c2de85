#pragma once

#include "modules/shadow_penumbra_fins/fins_settings.h"
#include "modules/shadows/shadow_technique.h"

#include <span>

namespace gnomon {

/// Adds passes that find the nearest depth layers of one light view's casters (depth peeling,
/// Everitt 2001). Array layer p_view_index of p_layers[k] receives the k-th nearest distinct depth
/// of each texel, reversed; 0 when there is none. p_layers: D32_SFLOAT texture arrays, one per
/// depth layer, with the usages DEPTH_ATTACHMENT, SAMPLED and, for ONE_PASS, COPY_TARGET.
///
/// When no caster is closed and the second layer is empty, the third is not drawn: the second peel
/// sets a flag on the GPU that predicates it. See is_layer_3_conditional.
///
/// r_texels: only for ONE_PASS with more than one layer, created when empty; a light's views share
/// it.
void add_layer_passes(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
		uint32_t p_view_index, std::span<const RGTexture> p_layers, Peeling p_peeling,
		RGBuffer &r_texels);

/// With Peeling::PASSES: true when the GPU decides whether layer 3 is drawn, depending on whether
/// layer 2 is empty. False for views in which layer 2 is certainly not empty, when nothing may be
/// skipped, and on devices without conditional rendering or stores in fragment shaders.
bool is_layer_3_conditional(const ShadowTechnique::Inputs &p_inputs, uint32_t p_view_index);

} // namespace gnomon
