#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "common/depth_inc.glsl"
#include "common/normal_inc.glsl"
#include "shadows/shadows_shared.h"

// Geometric normals for a host that draws none: on each axis from the neighbours that are on the same
// surface. Stored depth, near / z, is linear in pixels on a plane: of the three pixels ahead, around and
// behind, those are taken whose depths are closest to a line; where none are, the side with the smaller step.
layout(local_size_x = SURFACE_GROUP_SIZE, local_size_y = SURFACE_GROUP_SIZE) in;
layout(std140, set = 0, binding = SURFACE_BINDING_FRAME) restrict readonly buffer Frame {
	FrameConstants frame;
};
layout(set = 0, binding = SURFACE_BINDING_DEPTH) uniform texture2D depth_texture;
layout(set = 0, binding = SURFACE_BINDING_RESULT, r32ui) uniform writeonly uimage2D result_image;

const float NOWHERE = 1e30; // larger than every bend and step
const float MOST_BEND = 0.25; // of the smaller step: three pixels that bend more are on no surface together

float load_depth(ivec2 p_pixel) {
	const bool is_inside = all(greaterThanEqual(p_pixel, ivec2(0))) &&
			all(lessThan(p_pixel, ivec2(frame.size_px)));
	return is_inside ? texelFetch(depth_texture, p_pixel, 0).r : 0.0;
}

/// How far three depths in a row are from a line; NOWHERE where one is background.
float compute_bend(vec3 p_depths) {
	const bool is_there = min(min(p_depths.x, p_depths.y), p_depths.z) > 0.0;
	return is_there ? abs(p_depths.x - 2.0 * p_depths.y + p_depths.z) : NOWHERE;
}

/// To a single neighbour; NOWHERE where it is background.
float compute_step(float p_depth, float p_other) {
	return p_other > 0.0 ? abs(p_other - p_depth) : NOWHERE;
}

vec3 position_at(ivec2 p_pixel, float p_depth) {
	return position_from_depth(frame, p_pixel, p_depth);
}

/// Along the surface, of any length; zero where no neighbour gives it.
vec3 compute_tangent(ivec2 p_pixel, float p_depth, ivec2 p_step) {
	const float ahead = load_depth(p_pixel + p_step);
	const float behind = load_depth(p_pixel - p_step);
	const float ahead_bend = compute_bend(vec3(p_depth, ahead, load_depth(p_pixel + 2 * p_step)));
	const float behind_bend = compute_bend(vec3(p_depth, behind, load_depth(p_pixel - 2 * p_step)));
	const float middle_bend = compute_bend(vec3(behind, p_depth, ahead));
	const float least = min(min(ahead_bend, behind_bend), middle_bend);
	bool uses_ahead = middle_bend == least || ahead_bend == least;
	bool uses_behind = middle_bend == least || !uses_ahead;
	const float ahead_step = compute_step(p_depth, ahead);
	const float behind_step = compute_step(p_depth, behind);
	if (least > MOST_BEND * min(ahead_step, behind_step)) { // the nearer neighbour, if there is one
		uses_ahead = ahead_step < NOWHERE && ahead_step <= behind_step;
		uses_behind = behind_step < NOWHERE && !uses_ahead;
	}
	const vec3 here = position_at(p_pixel, p_depth);
	const vec3 from = uses_behind ? position_at(p_pixel - p_step, behind) : here;
	const vec3 to = uses_ahead ? position_at(p_pixel + p_step, ahead) : here;
	return to - from;
}

void main() {
	const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
	if (any(greaterThanEqual(pixel, ivec2(frame.size_px)))) {
		return;
	}
	const float depth = texelFetch(depth_texture, pixel, 0).r;
	uint packed = 0u;
	if (depth > 0.0) {
		const vec3 position = position_from_depth(frame, pixel, depth);
		const vec3 along_x = compute_tangent(pixel, depth, ivec2(1, 0));
		const vec3 along_y = compute_tangent(pixel, depth, ivec2(0, 1));
		vec3 normal = cross(along_x, along_y);
		const float length2 = dot(normal, normal);
		normal = length2 > 0.0 ? normal * inversesqrt(length2) : -normalize(position);
		packed = pack_normal(dot(normal, position) > 0.0 ? -normal : normal);
	}
	imageStore(result_image, pixel, uvec4(packed));
}
