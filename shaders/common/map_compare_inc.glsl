// The shadow comparison of a receiver with one texel of a light's depth map.
#ifndef MAP_COMPARE_INC_GLSL
#define MAP_COMPARE_INC_GLSL

#include "common/light_view_inc.glsl"

// The rasterizer snaps vertices to 1/256 texel, so a stored w may be off by the slope times that distance. Twice that
// is allowed for.
const float SNAP_TEXELS = 2.0 / 256.0;
// Height, in texels, that neighbouring facets of a curved surface may have above the receiver's plane when the light is
// along the normal. With this value, scaled by the stretch below, the mean error against the exact hard shadow
// (400 x 400 pixels, map of 1024) is 0.0035 in scene "terrain" and 0.0025 in "torus_knot". A constant height of
// 0.15 texels gave 0.0085 and 0.0026. The other scenes are similar.
const float CURVATURE_TEXELS = 0.08;
// Maximum factor by which grazing light increases that height.
const float MAX_STRETCH = 40.0;
// Maximum change of w along an offset on the receiver's plane, as a fraction of w (orthographic: of the view's depth
// range). Steeper planes exceed the map's resolution.
const float MAX_RELATIVE_CHANGE = 0.25;

/// Minimum difference in w between a blocker and the receiver's plane. The map cannot resolve smaller ones.
float hiding_margin(LightViewConstants p_view, MapPoint p_point) {
	const vec2 extent = texel_extent(p_view);
	const float scale = p_view.is_orthographic != 0u ? 1.0 / p_view.depth_scale : p_point.w;
	const float limit = MAX_RELATIVE_CHANGE * scale;
	const float snap = min(dot(abs(p_point.w_slope), extent) * SNAP_TEXELS, limit);
	const float w_unit = p_view.is_orthographic != 0u ? 1.0 : p_point.w;
	// Grazing light stretches the texel's footprint on the surface, and the height grows with it.
	const float steepness = length(p_point.w_slope) / w_unit;
	const float stretch = min(1.0 + steepness * steepness, MAX_STRETCH);
	return snap + CURVATURE_TEXELS * stretch * max(extent.x, extent.y) * w_unit;
}

/// The w that a caster in the texel must exceed to hide the receiver: the w of the receiver's own plane at the texel's
/// centre (receiver-plane depth bias) plus hiding_margin.
float hiding_w(LightViewConstants p_view, MapPoint p_point, ivec2 p_texel) {
	const vec2 extent = texel_extent(p_view);
	const vec2 centre = (vec2(p_texel) + 0.5) * extent - p_view.half_extent;
	const float scale = p_view.is_orthographic != 0u ? 1.0 / p_view.depth_scale : p_point.w;
	const float limit = MAX_RELATIVE_CHANGE * scale;
	const float change = clamp(dot(p_point.w_slope, centre - p_point.xy), -limit, limit);
	return p_point.w + change + hiding_margin(p_view, p_point);
}

/// Returns 1 for lit, 0 for hidden. p_stored: the map's depth at the texel; 0, an empty texel, hides nothing, also for
/// receivers beyond the far plane, whose w is below 0.
float compare_texel(
		LightViewConstants p_view, MapPoint p_point, ivec2 p_texel, float p_stored) {
	return p_stored > max(hiding_w(p_view, p_point, p_texel) * p_view.depth_scale, 0.0) ? 0.0 : 1.0;
}

/// Compares with the nearest texel; returns 1 for lit, 0 for hidden. Lit outside the map, where no caster projects.
float lookup_hard(texture2DArray p_map, LightViewConstants p_view, MapPoint p_point) {
	const ivec2 texel = ivec2(floor(texels_from_map(p_view, p_point.xy)));
	if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, ivec2(p_view.size_px)))) {
		return 1.0;
	}
	return compare_texel(p_view, p_point, texel,
			texelFetch(p_map, ivec3(texel, p_view.layer), 0).r);
}

#endif
