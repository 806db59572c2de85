// The method in metres: samples on the receiver's tangent plane, distributed as the entry points of the light that
// leaves at the receiver (make_scatter_samples in scatter_samples.h), so that all have the same weight.
#ifndef RECEIVER_SCATTER_DIPOLE_INC_GLSL
#define RECEIVER_SCATTER_DIPOLE_INC_GLSL

#include "common/sampling_inc.glsl"
#include "receiver_scatter/receiver_inc.glsl"

layout(set = 0, binding = SCATTER_BINDING_SAMPLES) readonly buffer Samples {
	vec2 samples[]; // offsets in radii
};

/// x, y and w in clip space of a point (p_position.w = 1) or a direction (0).
vec3 project(vec4 p_position) {
	return (frame.clip_from_camera_relative * p_position).xyw;
}

/// The pixel that shows a projected point; outside the image where it is behind the camera.
ivec2 find_pixel_of(vec3 p_projected) {
	if (!(p_projected.z > frame.near_m)) {
		return ivec2(-1);
	}
	const vec2 pixel = floor((0.5 + 0.5 * p_projected.xy / p_projected.z) * vec2(frame.size_px));
	return ivec2(clamp(pixel, vec2(-1.0), vec2(frame.size_px)));
}

/// By how much the mean squared distance of samples from the receiver grows on its tangent plane, because samples are
/// taken at pixel centres and average.comp averages pixels.
float find_blur_m2(Receiver p_receiver, int p_block_width) {
	// Variance of average.comp's window along one axis; 1/12 is that of rounding to a pixel.
	const float averaged_px2 = p_block_width == 1 ? 0.0 : p_block_width == 2 ? 0.5 : 1.5;
	// A pixel is 1 / cosine times as long on the plane along the view; at most 5 times.
	const float cosine = max(abs(dot(p_receiver.normal, normalize(p_receiver.position))), 0.2);
	return (averaged_px2 + 1.0 / 12.0) * (1.0 + 1.0 / (cosine * cosine)) * p_receiver.pixel_size_m *
			p_receiver.pixel_size_m;
}

/// Mean of the light at the samples.
vec3 spread_in_metres(ivec2 p_pixel, Receiver p_receiver) {
	vec3 axis_x;
	vec3 axis_y;
	find_tangents(p_receiver.normal, axis_x, axis_y);
	// A point of the plane is linear in its offset before the division by w.
	const vec3 projected = project(vec4(p_receiver.position, 1.0));
	const vec3 projected_x = project(vec4(axis_x, 0.0));
	const vec3 projected_y = project(vec4(axis_y, 0.0));
	const int block_width = find_block_width(p_receiver);
	const uint first = push.sample_count * find_set(p_pixel, block_width);
	const float blur_m2 = find_blur_m2(p_receiver, block_width);
	const bool refuses = refuses_others(p_receiver);
	vec3 sum = vec3(0.0);
	uint count = 0u;
	for (uint i = 0u; i < push.sample_count; ++i) {
		vec2 offset_m = p_receiver.radius_m * samples[first + i];
		// Move the sample inwards, so that the blur restores its mean squared distance.
		offset_m *= sqrt(max(1.0 - blur_m2 / max(dot(offset_m, offset_m), 1e-30), 0.0));
		const ivec2 other =
				find_pixel_of(projected + offset_m.x * projected_x + offset_m.y * projected_y);
		if (!is_in_image(other)) {
			continue;
		}
		const uvec4 packed = load_pixel(other);
		const vec3 expected = p_receiver.position + offset_m.x * axis_x + offset_m.y * axis_y;
		// Allows for a surface that curves away by up to 45 degrees, and for two pixel widths.
		const float tolerance_m = length(offset_m) + 2.0 * p_receiver.pixel_size_m;
		if (refuses ? is_same_surface(p_receiver, other, packed, expected, tolerance_m)
					: get_depth(packed) > 0.0) {
			sum += get_light(packed);
			++count;
		}
	}
	return count > 0u ? sum / float(count) : get_light(load_pixel(p_pixel));
}

#endif
