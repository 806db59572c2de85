#pragma once

#include "modules/shadows/shadow_technique.h"

namespace gnomon {

/// The greatest w (see LightViewConstants) that a caster has in any view: no blocker is nearer to
/// the light, so that none is searched farther out than it can reach.
float compute_nearest_w(const ShadowTechnique::Inputs &p_inputs, uint32_t p_view_index);
/// The greatest of all views.
float compute_nearest_w(const ShadowTechnique::Inputs &p_inputs);
/// What debug views of light depths show black and white, see ShadowTechnique::DebugView.
glm::vec2 compute_shown_depths(const ShadowTechnique::Inputs &p_inputs);

} // namespace gnomon
