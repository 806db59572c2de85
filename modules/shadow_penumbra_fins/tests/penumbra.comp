#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_penumbra_fins/penumbra_inc.glsl"

// Runs penumbra_inc.glsl for each item i. Input 2 i: theta, is outer, curve, starts dark; 2 i + 1: distance, nearest,
// farthest in metres, unused. Output i: transition, penumbra depth, visibility on the silhouette, 0.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) readonly buffer Input {
	vec4 items[];
};
layout(set = 0, binding = 1) writeonly buffer Output {
	vec4 results[];
};

void main() {
	const uint item = gl_GlobalInvocationID.x;
	if (2u * item >= uint(items.length())) {
		return;
	}
	const vec4 fin = items[2u * item];
	const vec4 input_m = items[2u * item + 1u];
	const bool is_outer = fin.y > 0.5;
	FinsViewConstants view;
	view.nearest_m = input_m.y;
	view.farthest_m = input_m.z;
	view.inner_divisor = 2.0 * input_m.z / input_m.y;
	const bool starts_dark = fin.w > 0.5;
	results[item] = vec4(penumbra_transition(fin.x, is_outer, int(fin.z), starts_dark),
			penumbra_depth(view, input_m.x, is_outer), penumbra_edge_visibility(int(fin.z)), 0.0);
}
