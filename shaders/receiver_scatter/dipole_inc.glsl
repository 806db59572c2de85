// The method in metres: samples on the receiver's tangent plane, distributed as the light that leaves
// it (scatter_samples.h), so that all weigh the same.
#ifndef RECEIVER_SCATTER_DIPOLE_INC_GLSL
#define RECEIVER_SCATTER_DIPOLE_INC_GLSL

#include "common/sampling_inc.glsl"
#include "receiver_scatter/receiver_inc.glsl"

layout(set = 0, binding = SCATTER_BINDING_SAMPLES) readonly buffer Samples {
	vec2 samples[]; // in radii
};

/// The pixel that shows a point; outside the picture where it lies behind the camera.
ivec2 find_pixel_of(vec3 p_position) {
	const vec4 clip = frame.clip_from_camera_relative * vec4(p_position, 1.0);
	if (!(clip.w > frame.near_m)) {
		return ivec2(-1);
	}
	const vec2 pixel = floor((0.5 + 0.5 * clip.xy / clip.w) * vec2(frame.size_px));
	return ivec2(clamp(pixel, vec2(-1.0), vec2(frame.size_px)));
}

vec3 spread_in_metres(ivec2 p_pixel, Receiver p_receiver) {
	vec3 axis_x;
	vec3 axis_y;
	find_tangents(p_receiver.normal, axis_x, axis_y);
	const uint first = push.sample_count * find_set(p_pixel, find_block_width(p_receiver));
	vec3 sum = vec3(0.0);
	uint count = 0u;
	for (uint i = 0u; i < push.sample_count; ++i) {
		const vec2 offset_m = p_receiver.radius_m * samples[first + i];
		const vec3 expected = p_receiver.position + offset_m.x * axis_x + offset_m.y * axis_y;
		const ivec2 other = find_pixel_of(expected);
		// Curved by as much as 45 degrees, and what a pixel's width makes of it.
		const float tolerance_m = length(offset_m) + 2.0 * p_receiver.pixel_size_m;
		if (is_sample(p_receiver, other, expected, tolerance_m)) {
			sum += load_light(other);
			++count;
		}
	}
	return count > 0u ? sum / float(count) : load_mask(p_pixel);
}

#endif
