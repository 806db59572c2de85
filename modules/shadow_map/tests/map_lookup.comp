#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "shadow_map/lookup_inc.glsl"

// Runs the filtered (result x) and the hard lookup (result y) of each point. Point xy: position in map coordinates,
// z: the receiver's w, w: width of the filter in texels.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) readonly buffer Input {
	vec4 points[];
};
layout(set = 0, binding = 1) writeonly buffer Output {
	vec4 results[];
};
layout(std140, set = 0, binding = 2) restrict readonly buffer View {
	LightViewConstants view;
};
layout(set = 0, binding = 3) uniform texture2DArray map_texture;

void main() {
	const uint item = gl_GlobalInvocationID.x;
	if (item >= uint(points.length())) {
		return;
	}
	MapPoint point;
	point.xy = points[item].xy;
	point.w = points[item].z;
	point.w_slope = vec2(0.0);
	results[item] = vec4(lookup_filtered(map_texture, view, point, int(points[item].w)),
			lookup_hard(map_texture, view, point), 0.0, 0.0);
}
