// Encoding of the penumbra maps. Pure functions, tested against C++ in modules/shadow_penumbra_fins/tests.
#ifndef PENUMBRA_INC_GLSL
#define PENUMBRA_INC_GLSL

#include "shadow_penumbra_fins/shadow_penumbra_fins_shared.h"

const float PI = 3.14159265358979;
// Class of a fin, stored in G of the penumbra map's colour (the paper stores it in B): 0.5 outer, 0 inner or no fin.
const float PENUMBRA_CLASS_OUTER = 0.5;
// Slack for inexact bilinear filtering: four outer texels may give slightly less than the class,
// four texels of 0 slightly more than 0.
const float PENUMBRA_CLASS_TOLERANCE = 1e-3;
const float PENUMBRA_EDGE_VISIBILITY = 0.3; // of the sine curve, on the silhouette: inner fins below, outer above

/// Visibility as a function of theta (Sun et al. 2010, section 2.1.3). Theta is 0 at the inner end, 0.5 on the edge and
/// 1 at the outer end. p_starts_dark: there is no inner half, so the outer half begins with
/// visibility 0 (technique outer_fins).
float penumbra_transition(float p_theta, bool p_is_outer, int p_curve, bool p_starts_dark) {
	const float theta = clamp(p_theta, p_is_outer ? 0.5 : 0.0, p_is_outer ? 1.0 : 0.5);
	if (p_curve == FINS_CURVE_LINEAR) {
		return p_starts_dark ? 2.0 * theta - 1.0 : theta;
	}
	if (!p_is_outer) {
		return (1.0 - cos(theta * PI)) * PENUMBRA_EDGE_VISIBILITY;
	}
	const float rise = sin((theta - 0.5) * PI);
	return p_starts_dark ? rise : rise * (1.0 - PENUMBRA_EDGE_VISIBILITY) + PENUMBRA_EDGE_VISIBILITY;
}

/// Visibility on the silhouette itself, where the inner and the outer half meet.
float penumbra_edge_visibility(int p_curve) {
	return p_curve == FINS_CURVE_LINEAR ? 0.5 : PENUMBRA_EDGE_VISIBILITY;
}

/// Converts a stored depth of a light view (1 near .. 0 far) to the distance along the view in metres.
/// Finite for 0, too.
float fin_distance(FinsViewConstants p_view, float p_stored) {
	return p_view.is_orthographic != 0u ? p_view.view_far_m - p_stored / p_view.depth_scale
										: p_view.depth_scale / max(p_stored, 1e-30);
}

/// Depth for the depth test of the penumbra map (greater wins, cleared to 0): any outer fin wins against any inner one,
/// and within a class the farthest fin wins.
float penumbra_depth(FinsViewConstants p_view, float p_distance_m, bool p_is_outer) {
	const float distance_m = clamp(p_distance_m, p_view.nearest_m, p_view.farthest_m);
	return distance_m /
			(p_is_outer ? p_view.farthest_m : p_view.farthest_m * p_view.inner_divisor);
}

#endif
