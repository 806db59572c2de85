// Encoding of the penumbra maps: pure functions, tested against C++ in tests/shaders.
#ifndef PENUMBRA_INC_GLSL
#define PENUMBRA_INC_GLSL

#include "shadow_penumbra_fins/shadow_penumbra_fins_shared.h"

const float PI = 3.14159265358979;
// The class, in g of the penumbra colour (the paper stores it in B): 0.5 outer, 0 inner or nothing.
const float PENUMBRA_CLASS_OUTER = 0.5;
// Slack for inexact bilinear filtering: four outer texels may give slightly less than the class,
// four texels of 0 slightly more than 0.
const float PENUMBRA_CLASS_TOLERANCE = 1e-3;
const float PENUMBRA_INNER_SHARE = 0.3; // visibility on the silhouette: inner below, outer above

/// Sun et al. 2010, section 2.1.3: visibility from theta, 0 (inner end) .. 0.5 (edge) .. 1 (outer).
/// p_starts_dark: there is no inner half, so the outer one begins at 0 (outer_fins).
float penumbra_transition(float p_theta, bool p_is_outer, int p_curve, bool p_starts_dark) {
	const float theta = clamp(p_theta, p_is_outer ? 0.5 : 0.0, p_is_outer ? 1.0 : 0.5);
	if (p_curve == FINS_CURVE_LINEAR) {
		return p_starts_dark ? 2.0 * theta - 1.0 : theta;
	}
	if (!p_is_outer) {
		return (1.0 - cos(theta * PI)) * PENUMBRA_INNER_SHARE;
	}
	const float rise = sin((theta - 0.5) * PI);
	return p_starts_dark ? rise : rise * (1.0 - PENUMBRA_INNER_SHARE) + PENUMBRA_INNER_SHARE;
}

/// Visibility on the silhouette itself, where the inner and the outer half meet.
float penumbra_border(int p_curve) {
	return p_curve == FINS_CURVE_LINEAR ? 0.5 : PENUMBRA_INNER_SHARE;
}

/// Depth of a light view (1 near .. 0 far) to the distance along the view, metres.
float fin_distance(FinsViewConstants p_view, float p_stored) {
	return p_view.is_orthographic != 0u ? p_view.view_far_m - p_stored / p_view.depth_scale
										: p_view.depth_scale / max(p_stored, 1e-30);
}

/// What the depth test compares (greater wins, cleared to 0): the farthest outer fin wins, any outer
/// one before any inner one.
float penumbra_depth(FinsViewConstants p_view, float p_distance_m, bool p_is_outer) {
	const float distance_m = clamp(p_distance_m, p_view.nearest_m, p_view.farthest_m);
	return distance_m /
			(p_is_outer ? p_view.farthest_m : p_view.farthest_m * p_view.inner_divisor);
}

#endif
