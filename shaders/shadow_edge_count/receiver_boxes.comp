#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_vote : require
#include "shadow_edge_count/count_pixels_inc.glsl"

// The bounds of the receivers of each group of 8 x 8 pixels, once per light view. One subgroup deals
// with one group.
layout(local_size_x_id = EDGE_COUNT_CONSTANT_GROUP_SIZE) in;
layout(std430, set = 0, binding = COUNT_BINDING_BOXES) writeonly buffer Boxes {
	CountGroupBox boxes[];
};

const float FAR = 3e38;
shared CountGroupBox view_boxes[EDGE_COUNT_MAX_VIEWS];

/// The receiver of one of the group's pixels. False: it is none, or no caster can hide it.
bool load_warped(uint p_index, out vec3 r_warped, out uint r_view) {
	const uint side = uint(EDGE_COUNT_GROUP_PX);
	const ivec2 pixel = ivec2(gl_WorkGroupID.xy * side + uvec2(p_index % side, p_index / side));
	r_warped = vec3(0.0);
	r_view = 0u;
	if (p_index >= side * side || !is_in_picture(pixel) || !is_receiver_pixel(pixel)) {
		return false;
	}
	r_warped = load_count_receiver(pixel, r_view).warped;
	return may_count_at(r_warped, r_view);
}

/// Several views: those of each row of pixels one after the other.
void find_boxes(uint p_pixel_count) {
	for (uint first = 0u; first < p_pixel_count; first += gl_SubgroupSize) {
		vec3 warped;
		uint view;
		bool waits = load_warped(first + gl_SubgroupInvocationID, warped, view);
		while (subgroupAny(waits)) {
			const uint chosen = subgroupMin(waits ? view : uint(EDGE_COUNT_MAX_VIEWS));
			const bool is_here = waits && view == chosen;
			const vec3 least = subgroupMin(is_here ? warped : vec3(FAR));
			const vec3 greatest = subgroupMax(is_here ? warped : vec3(-FAR));
			if (subgroupElect()) {
				view_boxes[chosen].least.xyz = min(view_boxes[chosen].least.xyz, least);
				view_boxes[chosen].greatest.xyz = max(view_boxes[chosen].greatest.xyz, greatest);
			}
			waits = waits && !is_here;
		}
	}
}

/// One view: each invocation collects its pixels first.
CountGroupBox find_box(uint p_pixel_count) {
	vec3 least = vec3(FAR);
	vec3 greatest = vec3(-FAR);
	for (uint first = 0u; first < p_pixel_count; first += gl_SubgroupSize) {
		vec3 warped;
		uint view;
		const bool is_here = load_warped(first + gl_SubgroupInvocationID, warped, view);
		least = is_here ? min(least, warped) : least;
		greatest = is_here ? max(greatest, warped) : greatest;
	}
	return CountGroupBox(
			vec4(subgroupMin(least), FAR), vec4(subgroupMax(greatest), -FAR));
}

void main() {
	const uint lane = gl_SubgroupInvocationID;
	const uint group = gl_WorkGroupID.y * light.group_count.x + gl_WorkGroupID.x;
	const uint pixel_count = uint(EDGE_COUNT_GROUP_PX * EDGE_COUNT_GROUP_PX);
	if (VIEW_COUNT == 1u) {
		const CountGroupBox box = find_box(pixel_count);
		if (subgroupElect()) {
			boxes[group] = box;
		}
		return;
	}
	for (uint v = lane; v < light.view_count; v += gl_SubgroupSize) {
		view_boxes[v] = CountGroupBox(vec4(FAR), vec4(-FAR));
	}
	subgroupMemoryBarrierShared();
	subgroupBarrier();
	find_boxes(pixel_count);
	subgroupMemoryBarrierShared();
	subgroupBarrier();
	for (uint v = lane; v < light.view_count; v += gl_SubgroupSize) {
		boxes[group * light.view_count + v] = view_boxes[v];
	}
}
