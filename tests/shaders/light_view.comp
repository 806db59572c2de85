#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/light_view_inc.glsl"

// Input: two points of a plane and its normal. Output: both points (map xy, w) in the map of the
// view that contains the first one, the index of that view, the slope of w, and the first point in
// texels.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) readonly buffer Input {
	vec4 points[]; // three per item
};
layout(set = 0, binding = 1) writeonly buffer Output {
	vec4 results[]; // three per item
};
layout(std140, set = 0, binding = 2) restrict readonly buffer Views {
	LightViewsConstants light_views;
};

void main() {
	const uint item = gl_GlobalInvocationID.x;
	if (3u * item >= uint(points.length())) {
		return;
	}
	const vec3 position = points[3u * item].xyz;
	const vec3 normal = points[3u * item + 2u].xyz;
	const uint view = find_view(light_views, position);
	const MapPoint first = project_to_map(light_views.views[view], position, normal);
	const MapPoint second =
			project_to_map(light_views.views[view], points[3u * item + 1u].xyz, normal);
	results[3u * item] = vec4(first.xy, first.w, float(view));
	results[3u * item + 1u] = vec4(second.xy, second.w, 0.0);
	results[3u * item + 2u] = vec4(first.w_slope, texels_from_map(light_views.views[view], first.xy));
}
