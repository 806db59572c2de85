#pragma once

#include "modules/shadows/visible_receivers.h"

namespace gnomon {

/// How far from a receiver is what may hide the directional light from it, or what a technique
/// with that light's penumbra widths looks at, metres; across the view.
double compute_fit_reach_m(
		const LightView &p_view, const LightSnapshot &p_light, const SceneSnapshot &p_scene);

/// Narrows a directional view, which holds all casters, to the receivers and what is within the
/// reach of them, so that a large ground does not take the texels of what the camera sees. Its size
/// is halved until it would be too small, and it moves in steps, so that it stays the same while
/// the camera moves a little. Other views, and those of which most is seen, stay as they are.
void fit_to_receivers(LightView &r_view, const VisibleReceivers &p_receivers, double p_reach_m);

} // namespace gnomon
