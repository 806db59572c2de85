// The receivers of a leaf.
#ifndef COUNT_SUBJECT_INC_GLSL
#define COUNT_SUBJECT_INC_GLSL

#include "shadow_edge_count/count_status_inc.glsl"
#include "shadow_edge_count/light_items_inc.glsl"
#include "shadow_edge_count/resolve_leaf_inc.glsl"

FETCHED_UINTS(COUNT_BINDING_LISTS, lists_buffer);
layout(std430, set = 0, binding = COUNT_BINDING_RESULTS) readonly buffer Results {
	CountLeafResult results[];
};
layout(std430, set = 0, binding = COUNT_BINDING_STATUS) buffer Status {
	uint status[]; // EDGE_COUNT_STATUS_*
};

layout(constant_id = EDGE_COUNT_CONSTANT_SUBGROUP_SIZE) const uint FULL_SUBGROUP_SIZE = 8u;
/// Active invocations of a subgroup: a work group may be smaller than the device's subgroups.
const uint SUBGROUP_SIZE = FULL_SUBGROUP_SIZE < gl_WorkGroupSize.x ? FULL_SUBGROUP_SIZE : gl_WorkGroupSize.x;
#include "shadow_edge_count/leaf_box_inc.glsl"
#include "shadow_edge_count/plane_fit_inc.glsl"

/// A leaf, and the receiver of it that an invocation processes.
struct CountSubject {
	CountLeaf leaf;
	CountLeafResult result;
	ivec2 pixel;
	bool is_receiver; // false: the leaf has fewer
	vec3 warped; // in the leaf's frame; meaningless if the leaf is wide
	CountReceiver receiver;
};

/// p_pixel: index of the pixel in the block, see find_pixel_in_block.
CountSubject load_subject(uint p_leaf, uint p_pixel, bool p_is_receiver) {
	CountSubject subject;
	subject.leaf = leaves[p_leaf];
	subject.result = results[p_leaf];
	subject.pixel = find_image_pixel(subject.leaf, p_pixel);
	subject.is_receiver = p_is_receiver;
	vec3 position = vec3(0.0, 0.0, 1.0);
	float offset_m = 0.0;
	if (p_is_receiver) {
		const ReceiverPixel pixel = load_receiver(frame_copy, subject.pixel);
		position = find_light_position(pixel.position);
		offset_m = pixel.offset_m;
	}
	subject.receiver = make_count_receiver(light, position, subject.leaf.axis_distance.w);
	// Edges of the receiver's own surface are about as far below it as it was moved.
	subject.receiver.min_d *= offset_m / frame_copy.max_receiver_offset_m;
	subject.warped = warp_to_frame(make_count_frame(subject.leaf.axis_distance.xyz), light.depth_far_m, position);
	return subject;
}

/// p_rank: of the receiver, in the leaf's order of pixels.
CountSubject load_ranked_subject(uint p_leaf, uint p_rank, bool p_is_valid) {
	const CountLeaf leaf = leaves[p_leaf];
	return load_subject(
			p_leaf, find_set_bit(leaf.pixels_flags.xy, p_rank), p_is_valid && p_rank < count_leaf_pixels(leaf));
}

/// The receiver of an invocation of a pass with one work group per leaf.
CountSubject load_group_subject(uint p_leaf, bool p_is_valid) {
	return load_ranked_subject(p_leaf, gl_LocalInvocationIndex / LANES_PER_RECEIVER, p_is_valid);
}

/// The bounds of the receivers of a subgroup for which p_is_selected is true.
CountBounds find_receiver_bounds(vec3 p_warped, bool p_is_selected) {
	const vec3 mean = find_mean_receiver(p_is_selected ? vec4(p_warped, 1.0) : vec4(0.0));
	PlaneMoments moments = PlaneMoments(vec3(0.0), vec2(0.0));
	add_to_moments(p_warped - mean, p_is_selected, moments);
	CountBounds bounds = make_count_bounds();
	bounds.slope = find_fitted_slope(moments);
	add_to_bounds(p_warped, p_is_selected, bounds);
	return find_subgroup_bounds(bounds);
}

uint ray_count = 0u; // receivers of the invocation that needed their own ray
uint iteration_count = 0u; // of loops over edges; an upper bound

/// Writes the faults and the number of rays of the subgroup. One invocation does: drivers insert subgroup operations
/// around other atomics, and would do so in divergent flow.
void report_subgroup_status() {
	const uint faults = subgroup_or(count_faults);
	const uint rays = subgroup_add(ray_count);
	const uint iterations = subgroup_max(iteration_count);
	// It only grows, so a value that was read before spares most of the atomic operations.
	const uint longest = subgroupBroadcastFirst(status[EDGE_COUNT_STATUS_LONGEST_COUNT]);
	const bool is_elected = subgroupElect();
	if (iterations > longest && is_elected) {
		atomicMax(status[EDGE_COUNT_STATUS_LONGEST_COUNT], iterations);
	}
	if ((faults | rays) != 0u && is_elected) {
		atomicOr(status[EDGE_COUNT_STATUS_FAULTS], faults << push.kind);
		atomicAdd(status[EDGE_COUNT_STATUS_RAYS], rays);
	}
}

#endif
