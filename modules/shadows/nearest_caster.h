#pragma once

#include "modules/shadows/shadow_technique.h"

namespace gnomon {

/// Upper bound of w (see LightViewConstants) over the view's casters: no blocker is nearer to the
/// light, which limits the radius of a blocker search.
float compute_nearest_w(const ShadowTechnique::Inputs &p_inputs, uint32_t p_view_index);
/// The maximum over all views.
float compute_nearest_w(const ShadowTechnique::Inputs &p_inputs);
/// Stored depths that a debug view of a light's depth map shows as black (x) and as white (y), see
/// ShadowTechnique::DebugView::is_light_depth.
glm::vec2 compute_debug_depth_range(const ShadowTechnique::Inputs &p_inputs);

} // namespace gnomon
