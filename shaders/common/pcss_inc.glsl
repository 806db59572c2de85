// Percentage-closer soft shadows (Fernando 2005) over the maps of one light.
#ifndef PCSS_INC_GLSL
#define PCSS_INC_GLSL

#include "common/map_tap_inc.glsl"
#include "common/sampling_inc.glsl"

/// Visibility of a receiver, 0..1. p_empty_views: bit i is set when the layer of view i was not drawn. p_radius: R in
/// metres; directional: the tangent of half the angular distance. p_nearest_w: upper bound of the casters' w.
/// p_tap_count: taps of the blocker search, and as many of the filter. p_angle_rad: rotation of the taps.
float pcss(texture2DArray p_map, uint p_empty_views, LightViewConstants p_view, MapPoint p_point,
		float p_radius, float p_nearest_w, uint p_tap_count, float p_angle_rad) {
	const float margin = hiding_margin(p_view, p_point);
	// A blocker with map coordinate w, at map offset o from the receiver, hides the point o / (w - w_receiver) of the
	// light's disc. So blockers are at most p_radius * (w - w_receiver) away.
	const vec2 extent = texel_extent(p_view);
	// No caster is farther away than the map reaches. A directional view is fitted to the casters, so a receiver may be
	// outside of it.
	const float map_reach = p_view.is_orthographic != 0u
			? length(abs(p_point.xy) + p_view.half_extent)
			: max(p_view.half_extent.x, p_view.half_extent.y);
	const float search_radius = min(p_radius * max(p_nearest_w - p_point.w, 0.0), map_reach);
	float blocker_w = 0.0;
	uint blocker_count = 0u;
	for (uint i = 0u; i < p_tap_count; ++i) {
		float w;
		const vec2 xy = p_point.xy + search_radius * vogel_disc(i, p_tap_count, p_angle_rad);
		if (is_hidden_at(p_map, p_empty_views, p_view, p_point, margin, xy, w)) {
			blocker_w += w;
			++blocker_count;
		}
	}
	const float mean_w = blocker_w / float(max(blocker_count, 1u));
	// The map cannot resolve filters of less than half a texel. A light without size keeps a hard shadow.
	const float min_radius = p_radius > 0.0 ? 0.5 * max(extent.x, extent.y) : 0.0;
	const float radius = max(p_radius * (mean_w - p_point.w), min_radius);
	// Early out: without blockers the receiver is lit, and no filter taps are needed.
	const uint filter_count = blocker_count > 0u ? p_tap_count : 0u;
	uint hidden_count = 0u;
	for (uint i = 0u; i < filter_count; ++i) {
		float w;
		const vec2 xy = p_point.xy + radius * vogel_disc(i, p_tap_count, p_angle_rad);
		hidden_count += is_hidden_at(p_map, p_empty_views, p_view, p_point, margin, xy, w) ? 1u : 0u;
	}
	return 1.0 - float(hidden_count) / float(p_tap_count);
}

#endif
