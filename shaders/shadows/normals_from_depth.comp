#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "common/depth_inc.glsl"
#include "common/normal_inc.glsl"
#include "shadows/shadows_shared.h"

// Computes geometric normals for a host that draws none, from the neighbours of each pixel on the same surface. On a
// plane the stored depth, near / z, is linear in pixels. So on each axis three triples of pixels are compared: the
// pixel with the next two, with the two before, and with one on each side. The triple whose depths are closest to
// linear gives the tangent. When none is close enough, the neighbour with the smaller depth step does.
layout(local_size_x = SURFACE_GROUP_SIZE, local_size_y = SURFACE_GROUP_SIZE) in;
layout(std140, set = 0, binding = SURFACE_BINDING_FRAME) restrict readonly buffer Frame {
	FrameConstants frame;
};
layout(set = 0, binding = SURFACE_BINDING_DEPTH) uniform texture2D depth_texture;
layout(set = 0, binding = SURFACE_BINDING_RESULT, r32ui) uniform writeonly uimage2D result_image;

const float NO_NEIGHBOUR = 1e30; // larger than every bend and step
const float MAX_BEND = 0.25; // times the smaller depth step: triples that bend more are not on one surface

float load_depth(ivec2 p_pixel) {
	const bool is_inside = all(greaterThanEqual(p_pixel, ivec2(0))) &&
			all(lessThan(p_pixel, ivec2(frame.size_px)));
	return is_inside ? texelFetch(depth_texture, p_pixel, 0).r : 0.0;
}

/// Second difference of three consecutive depths, 0 on a plane. NO_NEIGHBOUR if one is background.
float compute_bend(vec3 p_depths) {
	const bool is_surface = min(min(p_depths.x, p_depths.y), p_depths.z) > 0.0;
	return is_surface ? abs(p_depths.x - 2.0 * p_depths.y + p_depths.z) : NO_NEIGHBOUR;
}

/// Depth step to a neighbour. NO_NEIGHBOUR if that is background.
float compute_step(float p_depth, float p_other) {
	return p_other > 0.0 ? abs(p_other - p_depth) : NO_NEIGHBOUR;
}

vec3 position_at(ivec2 p_pixel, float p_depth) {
	return position_from_depth(frame, p_pixel, p_depth);
}

/// Tangent of the surface along p_step, not normalized; zero when no neighbour is on the surface.
vec3 compute_tangent(ivec2 p_pixel, float p_depth, ivec2 p_step) {
	const float ahead = load_depth(p_pixel + p_step);
	const float behind = load_depth(p_pixel - p_step);
	const float ahead_bend = compute_bend(vec3(p_depth, ahead, load_depth(p_pixel + 2 * p_step)));
	const float behind_bend = compute_bend(vec3(p_depth, behind, load_depth(p_pixel - 2 * p_step)));
	const float middle_bend = compute_bend(vec3(behind, p_depth, ahead));
	const float min_bend = min(min(ahead_bend, behind_bend), middle_bend);
	bool uses_ahead = middle_bend == min_bend || ahead_bend == min_bend;
	bool uses_behind = middle_bend == min_bend || !uses_ahead;
	const float ahead_step = compute_step(p_depth, ahead);
	const float behind_step = compute_step(p_depth, behind);
	if (min_bend > MAX_BEND * min(ahead_step, behind_step)) { // use the neighbour with the smaller step, if any
		uses_ahead = ahead_step < NO_NEIGHBOUR && ahead_step <= behind_step;
		uses_behind = behind_step < NO_NEIGHBOUR && !uses_ahead;
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
