#pragma once

#include "modules/shadows/visible_receivers.h"

namespace gnomon {

/// Bounds of the receivers in the view's space; empty without receivers.
Bounds find_bounds_in_view(const LightView &p_view, const VisibleReceivers &p_receivers);

/// Upper bound of the distance, in metres across the view, from a receiver to any caster that may
/// hide the directional light from it, and to any texel that a technique samples for its penumbra.
/// Receivers may be beyond the view's far plane. p_receivers: in the view's space.
double compute_fit_reach_m(const LightView &p_view, const LightSnapshot &p_light,
		const SceneSnapshot &p_scene, const Bounds &p_receivers);

/// Narrows a directional view, which holds all casters, to the receivers plus p_reach_m on each
/// side, so that texels are not spent on ground that the camera does not see. The view's size is
/// halved as often as the content still fits, and its centre is snapped to steps, so that the view
/// stays the same while the camera moves a little. Views of other lights, and views that are
/// mostly visible, are not changed. p_receivers: in the view's space.
void fit_to_receivers(LightView &r_view, const Bounds &p_receivers, double p_reach_m);

} // namespace gnomon
