#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "common/depth_inc.glsl"
#include "common/normal_inc.glsl"
#include "shadows/shadows_shared.h"

// Geometric normals for a host that draws none: on each axis from the neighbour that lies on the same
// surface. Stored depth, near / z, is linear in pixels on a plane, so that is the side on which two
// steps on are twice one step.
layout(local_size_x = SURFACE_GROUP_SIZE, local_size_y = SURFACE_GROUP_SIZE) in;
layout(set = 0, binding = SURFACE_BINDING_FRAME) uniform Frame {
	FrameConstants frame;
};
layout(set = 0, binding = SURFACE_BINDING_DEPTH) uniform texture2D depth_texture;
layout(set = 0, binding = SURFACE_BINDING_RESULT, r32ui) uniform writeonly uimage2D result_image;

const float NOWHERE = 1e30; // larger than every error

float load_depth(ivec2 p_pixel) {
	const bool is_inside = all(greaterThanEqual(p_pixel, ivec2(0))) &&
			all(lessThan(p_pixel, ivec2(frame.size_px)));
	return is_inside ? texelFetch(depth_texture, p_pixel, 0).r : 0.0;
}

/// How far the depths on that side are from a line, and from each other where that does not tell.
float compute_error(float p_depth, ivec2 p_pixel, ivec2 p_step) {
	const float near_depth = load_depth(p_pixel + p_step);
	const float far_depth = load_depth(p_pixel + 2 * p_step);
	if (near_depth <= 0.0) {
		return NOWHERE;
	}
	return far_depth > 0.0 ? abs(far_depth - near_depth - (near_depth - p_depth))
						   : abs(near_depth - p_depth);
}

/// Along the surface by one pixel; zero where no neighbour tells.
vec3 compute_tangent(vec3 p_position, float p_depth, ivec2 p_pixel, ivec2 p_step) {
	const float ahead = compute_error(p_depth, p_pixel, p_step);
	const float behind = compute_error(p_depth, p_pixel, -p_step);
	if (min(ahead, behind) >= NOWHERE) {
		return vec3(0.0);
	}
	const float side = ahead <= behind ? 1.0 : -1.0;
	const ivec2 other = p_pixel + (ahead <= behind ? p_step : -p_step);
	return side * (position_from_depth(frame, other, load_depth(other)) - p_position);
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
		const vec3 along_x = compute_tangent(position, depth, pixel, ivec2(1, 0));
		const vec3 along_y = compute_tangent(position, depth, pixel, ivec2(0, 1));
		vec3 normal = cross(along_x, along_y);
		const float length2 = dot(normal, normal);
		normal = length2 > 0.0 ? normal * inversesqrt(length2) : -normalize(position);
		packed = pack_normal(dot(normal, position) > 0.0 ? -normal : normal);
	}
	imageStore(result_image, pixel, uvec4(packed));
}
