#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "shadow_edge_count/count_buffers_inc.glsl"
#include "shadow_edge_count/count_cull_inc.glsl"

// For each block of pixels the edges that may matter to any of its receivers, view by view, in their
// own order; then the block goes to those of its kind. One subgroup deals with one block.
layout(local_size_x_id = EDGE_COUNT_CONSTANT_GROUP_SIZE) in;
layout(set = 0, binding = COUNT_BINDING_LIGHT) uniform Light {
	CountLightConstants light;
};
layout(std430, set = 0, binding = COUNT_BINDING_BOXES) readonly buffer Boxes {
	CountGroupBox boxes[];
};
layout(set = 0, binding = COUNT_BINDING_TOTALS) uniform utextureBuffer totals_buffer;
layout(std430, set = 0, binding = COUNT_BINDING_ENDS) writeonly buffer Ends {
	uint ends[];
};
layout(std430, set = 0, binding = COUNT_BINDING_LISTS) writeonly buffer Lists {
	uint lists[];
};
layout(std430, set = 0, binding = COUNT_BINDING_BLOCKS) writeonly buffer Blocks {
	uint blocks[];
};
layout(std430, set = 0, binding = COUNT_BINDING_DISPATCHES) buffer Dispatches {
	uint dispatches[];
};

uint find_total(uint p_index) {
	return texelFetch(totals_buffer, int(p_index)).r;
}

/// Bounds of the block's receivers in one view.
void find_block_box(uvec2 p_block, uint p_view, out vec3 r_least, out vec3 r_greatest) {
	const float FAR = 3e38;
	const uint side = light.groups_per_block_side;
	r_least = vec3(FAR);
	r_greatest = vec3(-FAR);
	for (uint i = gl_SubgroupInvocationID; i < side * side; i += gl_SubgroupSize) {
		const uvec2 group = min(
				p_block * side + uvec2(i % side, i / side), light.group_count - uvec2(1u));
		const CountGroupBox box =
				boxes[(group.y * light.group_count.x + group.x) * light.view_count + p_view];
		r_least = min(r_least, box.least.xyz);
		r_greatest = max(r_greatest, box.greatest.xyz);
	}
	r_least = subgroupMin(r_least);
	r_greatest = subgroupMax(r_greatest);
}

/// Lists the edges of one view from r_end on, as far as there is room, and counts all of them.
void list_view(uint p_block_index, uint p_view, CountBox p_box, uint p_edge_count, inout uint r_end) {
	for (uint first = 0u; first < p_edge_count; first += gl_SubgroupSize) {
		const uint edge = first + gl_SubgroupInvocationID;
		const uint record = p_view * light.record_capacity + min(edge, p_edge_count - 1u);
		const bool is_used = edge < p_edge_count &&
				find_count_use(light.views[p_view], p_box, load_count_record(record)) != 0u;
		const uvec4 used = subgroupBallot(is_used);
		const uint place = r_end + subgroupBallotExclusiveBitCount(used);
		if (is_used && place < light.list_capacity) {
			lists[p_block_index * light.list_capacity + place] = record;
		}
		r_end += subgroupBallotBitCount(used);
	}
}

/// Puts the block into the list of its kind. In no order: what a block's pixels get does not depend on it.
void add_block(uint p_block_index, uint p_kind) {
	const uint first = 3u * p_kind;
	const uint place = atomicAdd(dispatches[first], 1u);
	blocks[p_kind * light.block_count.x * light.block_count.y + place] = p_block_index;
	dispatches[first + 1u] = light.groups_per_block_side * light.groups_per_block_side;
	dispatches[first + 2u] = 1u;
	if (p_kind == uint(EDGE_COUNT_BLOCKS_FILTERED)) {
		const uvec2 map_groups = (light.views[0].map_size_px + uint(MAP_RESOLVE_GROUP_SIZE) - 1u) /
				uint(MAP_RESOLVE_GROUP_SIZE);
		dispatches[EDGE_COUNT_DISPATCH_MAP] = map_groups.x;
		dispatches[EDGE_COUNT_DISPATCH_MAP + 1] = map_groups.y;
		dispatches[EDGE_COUNT_DISPATCH_MAP + 2] = light.view_count;
	}
}

void main() {
	const uvec2 block = gl_WorkGroupID.xy;
	const uint block_index = block.y * light.block_count.x + block.x;
	const uint first_end = block_index * uint(EDGE_COUNT_ENDS_PER_BLOCK);
	uint end = 0u;
	bool is_over = false;
	for (uint v = 0u; v < light.view_count; ++v) {
		vec3 least;
		vec3 greatest;
		find_block_box(block, v, least, greatest);
		if (least.x <= greatest.x) {
			const uint edge_count = find_total(uint(EDGE_COUNT_TOTAL_RECORDS) + v);
			is_over = is_over || edge_count > light.record_capacity ||
					find_total(uint(EDGE_COUNT_TOTAL_FRAGMENTS) + v) > light.fragment_capacity;
			list_view(block_index, v, make_count_box(light.views[v], least, greatest),
					min(edge_count, light.record_capacity), end);
		}
		if (subgroupElect()) {
			ends[first_end + v] = end;
		}
	}
	is_over = is_over || end > light.list_capacity;
	if (subgroupElect()) {
		add_block(block_index,
				is_over ? uint(EDGE_COUNT_BLOCKS_FILTERED)
						: (end > 0u ? uint(EDGE_COUNT_BLOCKS_COUNTED) : uint(EDGE_COUNT_BLOCKS_PLAIN)));
	}
}
