#pragma once

#include "modules/shadows/shadow_technique.h"

namespace gnomon {

/// Upper bound of w (see LightViewConstants) over the view's casters: no blocker is nearer to the
/// light, which limits the radius of a blocker search.
float compute_nearest_w(const ShadowTechnique::Inputs &p_inputs, uint32_t p_view_index);
/// The maximum over all views.
float compute_nearest_w(const ShadowTechnique::Inputs &p_inputs);
/// The depths that debug views of light depths show black and white, see
/// ShadowTechnique::DebugView.
glm::vec2 compute_shown_depths(const ShadowTechnique::Inputs &p_inputs);

} // namespace gnomon
