// One tap of a filter that may reach beyond the sides of the receiver's light view into other views.
#ifndef MAP_TAP_INC_GLSL
#define MAP_TAP_INC_GLSL

#extension GL_EXT_control_flow_attributes : require

#include "common/map_compare_inc.glsl"
#include "common/receiver_pixels_inc.glsl"

// Lower limit of the receiver plane's w at a tap, as a fraction of the receiver's w. Beyond the plane's horizon its w
// would be 0 or less, and everything would count as a blocker.
const float MIN_PLANE_W_RATIO = 0.02;

/// Returns the w of the nearest caster along the ray from the light through p_xy. w and p_xy are in the map space of
/// p_view, the receiver's view, even when another view contains the ray. 0: no caster, or its view was not drawn.
float lookup_w(
		texture2DArray p_map, uint p_empty_views, LightViewConstants p_view, vec2 p_xy) {
	const ivec2 texel = ivec2(floor(texels_from_map(p_view, p_xy)));
	const bool is_inside =
			all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, ivec2(p_view.size_px)));
	const ivec2 fetched = clamp(texel, ivec2(0), ivec2(p_view.size_px) - 1);
	const float stored = texelFetch(p_map, ivec3(fetched, p_view.layer), 0).r;
	const bool is_drawn = (p_empty_views & (1u << p_view.layer)) == 0u;
	// Beyond the sides of a single view its border texel is used: for a spot light it represents
	// casters outside the cone; the border of a directional light's map, which holds all casters,
	// is empty.
	float w = is_drawn ? stored / p_view.depth_scale : 0.0;
	// Beyond the side of one of six views, the adjacent view is read. This is a loop instead of a branch because
	// software drivers (llvmpipe) execute both sides of a branch, but skip a loop that no invocation enters.
	[[dont_unroll]] for (bool is_needed = !is_inside && light_views.view_count > 1u && p_view.is_orthographic == 0u; is_needed;
			is_needed = false) {
		const vec3 direction =
				transpose(mat3(p_view.view_from_camera_relative)) * vec3(p_xy, 1.0);
		const uint other_index =
				find_view_of_direction(mat3(light_views.light_from_camera_relative) * direction);
		const LightViewConstants other = light_views.views[other_index];
		const vec3 r = mat3(other.view_from_camera_relative) * direction;
		const ivec2 other_texel = clamp(ivec2(floor(texels_from_map(other, r.xy / r.z))), ivec2(0),
				ivec2(other.size_px) - 1);
		// For a point on the ray, w = 1 / z in the two views. Their ratio is that of the z, which is r.z.
		w = texelFetch(p_map, ivec3(other_texel, other.layer), 0).r / other.depth_scale * r.z;
		w = (p_empty_views & (1u << other_index)) != 0u ? 0.0 : w;
	}
	return w;
}

/// True when the stored depth at a tap hides the receiver. p_margin: see hiding_margin. p_xy: the tap, in the map space
/// of p_view. r_w: the w stored there.
bool is_hidden_at(texture2DArray p_map, uint p_empty_views, LightViewConstants p_view,
		MapPoint p_point, float p_margin, vec2 p_xy, out float r_w) {
	// The receiver's own plane at the texel's centre, not at the tap: no depth bias to tune.
	const vec2 extent = texel_extent(p_view);
	const vec2 centre =
			(floor(texels_from_map(p_view, p_xy)) + 0.5) * extent - p_view.half_extent;
	const float plane_w = p_point.w + dot(p_point.w_slope, centre - p_point.xy);
	r_w = lookup_w(p_map, p_empty_views, p_view, p_xy);
	const float min_plane_w = min(p_point.w, p_point.w * MIN_PLANE_W_RATIO);
	// An empty texel, whose w is 0, hides nothing, also for receivers beyond the far plane.
	return r_w > max(max(plane_w, min_plane_w) + p_margin, 0.0);
}

#endif
