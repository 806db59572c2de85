#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_penumbra_fins/fin_inc.glsl"

// Runs fin_inc.glsl for each item i. Input 3 i: position, corner; 3 i + 1: normal, normal_sign; 3 i + 2: r, t, 1 for an
// orthographic view. Output 2 i: clip position; 2 i + 1: theta.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) readonly buffer Input {
	vec4 items[];
};
layout(set = 0, binding = 1) writeonly buffer Output {
	vec4 results[];
};
layout(std140, set = 0, binding = 2) restrict readonly buffer Constants {
	mat4 view_from_node;
};

void main() {
	const uint item = gl_GlobalInvocationID.x;
	if (3u * item >= uint(items.length())) {
		return;
	}
	const vec4 position_corner = items[3u * item];
	const vec4 normal = items[3u * item + 1u];
	const vec4 widths = items[3u * item + 2u];
	FinsPush push;
	push.view_from_node = view_from_node;
	push.normal_sign = normal.w;
	FinsViewConstants view;
	view.half_extent = vec2(0.5, 0.25);
	view.is_orthographic = uint(widths.z);
	view.view_far_m = 10.0;
	// Orthographic: 1 / (far - near) with near = 0; perspective: near.
	view.depth_scale = widths.z > 0.5 ? 0.1 : 0.001;
	view.outer_width_m = widths.x;
	view.inner_width_m = widths.y;
	const uint corner = uint(position_corner.w);
	results[2u * item] = fin_position_clip(view, push, corner, position_corner.xyz, normal.xyz);
	results[2u * item + 1u] = vec4(fin_theta(corner));
}
