// Projection of points and planes into a light view. See LightViewConstants for the spaces.
#ifndef LIGHT_VIEW_INC_GLSL
#define LIGHT_VIEW_INC_GLSL

#include "shared/light_shared.h"

/// A receiver in map coordinates, and how w changes over the map on the receiver's plane.
struct MapPoint {
	vec2 xy;
	// Perspective: 0 behind the light. Orthographic: 0 or less beyond the far plane, which is behind all casters but not
	// behind all receivers.
	float w;
	vec2 w_slope; // dw/dx, dw/dy on the receiver's plane: exact, since w is linear on a plane
};

/// Index of the view, of six, that contains a direction in the light's axes. As for a cube map, the largest component
/// decides.
uint find_view_of_direction(vec3 p_direction_light) {
	const vec3 r = p_direction_light;
	const vec3 size = abs(r);
	if (size.x >= size.y && size.x >= size.z) {
		return r.x >= 0.0 ? 0u : 1u;
	}
	if (size.y >= size.z) {
		return r.y >= 0.0 ? 2u : 3u;
	}
	return r.z >= 0.0 ? 4u : 5u;
}

/// Index of the light view that contains a camera-relative position.
uint find_view(LightViewsConstants p_views, vec3 p_position) {
	return p_views.view_count <= 1u
			? 0u
			: find_view_of_direction(
					  (p_views.light_from_camera_relative * vec4(p_position, 1.0)).xyz);
}

/// Projects a receiver into a view's map space. p_position and p_normal, the unit normal of the receiver's plane, are
/// camera-relative.
MapPoint project_to_map(LightViewConstants p_view, vec3 p_position, vec3 p_normal) {
	const vec3 r = (p_view.view_from_camera_relative * vec4(p_position, 1.0)).xyz;
	const vec3 n = mat3(p_view.view_from_camera_relative) * p_normal;
	MapPoint point;
	if (p_view.is_orthographic != 0u) {
		point.xy = r.xy;
		point.w = p_view.far_m - r.z;
		point.w_slope = n.z == 0.0 ? vec2(0.0) : n.xy / n.z;
	} else {
		point.w = r.z > 0.0 ? 1.0 / r.z : 0.0;
		point.xy = r.xy * point.w;
		const float height = dot(n, r); // signed distance of the plane from the light
		// Near 0 the plane passes through the light and is seen edge-on: no finite slope.
		point.w_slope = abs(height) < 1e-7 ? vec2(0.0) : n.xy / height;
	}
	return point;
}

/// True when the receiver is behind the light's view, so that no caster hides it.
bool is_behind_view(LightViewConstants p_view, MapPoint p_point) {
	return p_view.is_orthographic == 0u && p_point.w <= 0.0;
}

/// Map coordinates to texel coordinates: texel centres are at integers plus 0.5.
vec2 texels_from_map(LightViewConstants p_view, vec2 p_xy) {
	return (p_xy / p_view.half_extent * 0.5 + 0.5) * vec2(p_view.size_px);
}

/// Size of one texel in map coordinates.
vec2 texel_extent(LightViewConstants p_view) {
	return 2.0 * p_view.half_extent / vec2(p_view.size_px);
}

#endif
