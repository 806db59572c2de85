// The shadow comparison of a receiver with one texel of a light's depth map.
#ifndef MAP_COMPARE_INC_GLSL
#define MAP_COMPARE_INC_GLSL

#include "common/light_view_inc.glsl"

// The rasteriser snaps vertices to 1/256 texel, so a stored w may be off by the slope times that
// distance; twice that is allowed for.
const float SNAP_TEXELS = 2.0 / 256.0;
// Height of neighbouring facets of a curved surface above the receiver's plane, as a fraction of a
// texel, for light along the normal. Mean error against the exact hard shadow (400 x 400, map
// 1024): "terrain" .0085 with a constant 0.15, .0035 with this; "torus_knot" .0026 and .0025;
// the other scenes similar.
const float CURVATURE_TEXELS = 0.08;
const float MAX_STRETCH = 40.0;
// Limit of the change of w within an offset, as a fraction of w (orthographic: of the view's depth):
// steeper planes exceed the map's resolution.
const float MAX_RELATIVE_CHANGE = 0.25;

/// Minimum difference in w between a blocker and the receiver's plane: what the map cannot resolve.
float hiding_margin(LightViewConstants p_view, MapPoint p_point) {
	const vec2 extent = texel_extent(p_view);
	const float scale = p_view.is_orthographic != 0u ? 1.0 / p_view.depth_scale : p_point.w;
	const float limit = MAX_RELATIVE_CHANGE * scale;
	const float snap = min(dot(abs(p_point.w_slope), extent) * SNAP_TEXELS, limit);
	const float w_unit = p_view.is_orthographic != 0u ? 1.0 : p_point.w;
	// Grazing light stretches the texel's footprint on the surface, and the height grows with it
	// too.
	const float steepness = length(p_point.w_slope) / w_unit;
	const float stretch = min(1.0 + steepness * steepness, MAX_STRETCH);
	return snap + CURVATURE_TEXELS * stretch * max(extent.x, extent.y) * w_unit;
}

/// The w that a caster in the texel must exceed to hide the receiver: the receiver's own plane at
/// the texel's centre (receiver-plane bias), plus what the map cannot resolve.
float hiding_w(LightViewConstants p_view, MapPoint p_point, ivec2 p_texel) {
	const vec2 extent = texel_extent(p_view);
	const vec2 centre = (vec2(p_texel) + 0.5) * extent - p_view.half_extent;
	const float scale = p_view.is_orthographic != 0u ? 1.0 / p_view.depth_scale : p_point.w;
	const float limit = MAX_RELATIVE_CHANGE * scale;
	const float change = clamp(dot(p_point.w_slope, centre - p_point.xy), -limit, limit);
	return p_point.w + change + hiding_margin(p_view, p_point);
}

/// 1 lit, 0 hidden. p_stored: the map's depth at the texel.
float compare_texel(
		LightViewConstants p_view, MapPoint p_point, ivec2 p_texel, float p_stored) {
	return p_stored > hiding_w(p_view, p_point, p_texel) * p_view.depth_scale ? 0.0 : 1.0;
}

/// Nearest texel. Outside the map: lit, since no caster projects there.
float lookup_hard(texture2DArray p_map, LightViewConstants p_view, MapPoint p_point) {
	const ivec2 texel = ivec2(floor(texels_from_map(p_view, p_point.xy)));
	if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, ivec2(p_view.size_px)))) {
		return 1.0;
	}
	return compare_texel(p_view, p_point, texel,
			texelFetch(p_map, ivec3(texel, p_view.layer), 0).r);
}

#endif
