#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_vote : require
#include "common/work_rows_inc.glsl"
#include "shadow_edge_count/count_box_inc.glsl"
#include "shadow_edge_count/count_pixels_inc.glsl"

// The bounds of the receivers of each block of pixels, in each light view that holds some of them. One
// subgroup deals with one block.
layout(local_size_x_id = EDGE_COUNT_CONSTANT_GROUP_SIZE) in;
layout(std430, set = 0, binding = COUNT_BINDING_BOXES) writeonly buffer Boxes {
	CountBlockBox boxes[];
};
layout(std430, set = 0, binding = COUNT_BINDING_PRESENT) writeonly buffer Present {
	uint present_boxes[]; // of each block, bit EDGE_COUNT_BOXES_PER_BLOCK * view + box
};

const uint PIXEL_COUNT = uint(EDGE_COUNT_BLOCK_PX * EDGE_COUNT_BLOCK_PX);
const uint PIXELS_PER_INVOCATION = (PIXEL_COUNT + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
const uint NO_VIEW = 0xffffffffu;

/// The receiver of one of the block's pixels. Its view is NO_VIEW where there is none, or none that a caster
/// can hide.
CountPoint load_point(uint p_index) {
	const uint side = uint(EDGE_COUNT_BLOCK_PX);
	const ivec2 pixel = ivec2(uvec2(gl_WorkGroupID.x, find_work_row()) * side + uvec2(p_index % side, p_index / side));
	CountPoint point = CountPoint(vec3(0.0), NO_VIEW, vec3(0.0), vec2(0.0));
	if (p_index < PIXEL_COUNT && is_in_picture(pixel) && is_receiver_pixel(pixel)) {
		const CountPoint loaded = load_count_point(pixel);
		if (may_count_at(loaded)) {
			point = loaded;
		}
	}
	return point;
}

/// Where to part receivers between two w: in the middle where they are far apart, else before all.
float find_split(float p_least, float p_greatest) {
	const float APART_SIZES = 0.05; // of S
	const float apart_m =
			light.is_directional != 0u ? p_greatest - p_least : 1.0 / p_least - 1.0 / p_greatest;
	return apart_m > APART_SIZES * light.scene_size_m ? 0.5 * (p_least + p_greatest) : -COUNT_FAR;
}

/// The bounds of some of the block's receivers, about the plane of one of them. Empty where there is none.
CountBounds find_bounds(CountPoint p_points[PIXELS_PER_INVOCATION], bool p_is_here[PIXELS_PER_INVOCATION]) {
	CountBounds bounds = make_count_bounds();
	bool is_any = false;
	vec2 slope = vec2(0.0);
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		slope = p_is_here[i] && !is_any ? p_points[i].slope : slope;
		is_any = is_any || p_is_here[i];
	}
	const uvec4 lanes = subgroupBallot(is_any);
	const uint leader = subgroupAny(is_any) ? subgroupBallotFindLSB(lanes) : 0u;
	slope = subgroupBroadcast(slope, leader);
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		const vec3 warped = p_points[i].warped;
		const float range = warped.z - dot(slope, warped.xy);
		bounds.least = p_is_here[i] ? min(bounds.least, warped.xy) : bounds.least;
		bounds.greatest = p_is_here[i] ? max(bounds.greatest, warped.xy) : bounds.greatest;
		bounds.range.x = p_is_here[i] ? min(bounds.range.x, range) : bounds.range.x;
		bounds.range.y = p_is_here[i] ? max(bounds.range.y, range) : bounds.range.y;
	}
	return CountBounds(subgroupMin(bounds.least), subgroupMax(bounds.greatest), slope,
			vec2(subgroupMin(bounds.range.x), subgroupMax(bounds.range.y)));
}

void main() {
	CountPoint points[PIXELS_PER_INVOCATION];
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		points[i] = load_point(i * gl_WorkGroupSize.x + gl_SubgroupInvocationID);
	}
	const uint block = find_work_row() * light.block_count.x + gl_WorkGroupID.x;
	uint present = 0u;
	uint view = 0u;
	while (true) {
		// The first of the views that are left.
		uint next = NO_VIEW;
		for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
			next = points[i].view >= view ? min(next, points[i].view) : next;
		}
		view = subgroupMin(next);
		if (view == NO_VIEW) {
			break;
		}
		float least_w = COUNT_FAR;
		float greatest_w = -COUNT_FAR;
		for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
			least_w = points[i].view == view ? min(least_w, points[i].warped.z) : least_w;
			greatest_w = points[i].view == view ? max(greatest_w, points[i].warped.z) : greatest_w;
		}
		const float split = find_split(subgroupMin(least_w), subgroupMax(greatest_w));
		for (uint box = 0u; box < uint(EDGE_COUNT_BOXES_PER_BLOCK); ++box) {
			bool is_here[PIXELS_PER_INVOCATION];
			for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
				is_here[i] = points[i].view == view &&
						(points[i].warped.z >= split) == (box == uint(EDGE_COUNT_BOX_NEAR));
			}
			const CountBounds bounds = find_bounds(points, is_here);
			if (!is_count_bounds_empty(bounds)) {
				present |= 1u << (uint(EDGE_COUNT_BOXES_PER_BLOCK) * view + box);
				if (subgroupElect()) {
					boxes[(block * VIEW_COUNT + view) * uint(EDGE_COUNT_BOXES_PER_BLOCK) + box] =
							CountBlockBox(vec4(bounds.least, bounds.greatest), vec4(bounds.slope, bounds.range));
				}
			}
		}
		++view;
	}
	if (subgroupElect()) {
		present_boxes[block] = present;
	}
}
