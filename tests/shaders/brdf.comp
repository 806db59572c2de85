#version 460
#extension GL_GOOGLE_include_directive : require
#include "renderer/brdf_inc.glsl"

// Computes what a surface with its normal along +z reflects from one direction into another.
// Output: rgb, see reflect_light.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) readonly buffer Input {
	vec4 cases[]; // three per item: material; base colour; angles (rad) of light and viewer, viewer's azimuth
};
layout(set = 0, binding = 1) writeonly buffer Output {
	vec4 results[];
};

void main() {
	const uint item = gl_GlobalInvocationID.x;
	if (3u * item >= uint(cases.length())) {
		return;
	}
	const vec4 angles = cases[3u * item + 2u];
	const vec3 to_light = vec3(sin(angles.x), 0.0, cos(angles.x));
	const vec3 to_viewer = vec3(sin(angles.y) * vec2(cos(angles.z), sin(angles.z)), cos(angles.y));
	const Surface surface = make_surface(cases[3u * item + 1u].rgb, cases[3u * item]);
	results[item] = vec4(reflect_light(surface, vec3(0.0, 0.0, 1.0), to_viewer, to_light), 0.0);
}
