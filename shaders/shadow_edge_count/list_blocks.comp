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

/// Least and greatest x', y', w of receivers.
struct Bounds {
	vec3 least;
	vec3 greatest;
};

/// Of those boxes of the block's groups whose middle w lies in a range.
Bounds find_bounds(uvec2 p_block, uint p_view, float p_least_w, float p_greatest_w) {
	const float FAR = 3e38;
	const uint side = light.groups_per_block_side;
	Bounds bounds = Bounds(vec3(FAR), vec3(-FAR));
	const uint count = side * side * uint(EDGE_COUNT_BOXES_PER_GROUP);
	for (uint i = gl_SubgroupInvocationID; i < count; i += gl_SubgroupSize) {
		const uint place = i / uint(EDGE_COUNT_BOXES_PER_GROUP);
		const uvec2 group = min(
				p_block * side + uvec2(place % side, place / side), light.group_count - uvec2(1u));
		const CountGroupBox box =
				boxes[((group.y * light.group_count.x + group.x) * light.view_count + p_view) *
								uint(EDGE_COUNT_BOXES_PER_GROUP) +
						i % uint(EDGE_COUNT_BOXES_PER_GROUP)];
		const float middle = 0.5 * (box.least.z + box.greatest.z);
		const bool is_inside = box.least.x <= box.greatest.x && middle >= p_least_w &&
				middle < p_greatest_w;
		bounds.least = is_inside ? min(bounds.least, box.least.xyz) : bounds.least;
		bounds.greatest = is_inside ? max(bounds.greatest, box.greatest.xyz) : bounds.greatest;
	}
	return Bounds(subgroupMin(bounds.least), subgroupMax(bounds.greatest));
}

/// Lists the edges of one view from r_end on, as far as there is room, and counts all of them. Receivers
/// lie in either of two boxes, or in the near one alone.
void list_view(uint p_block_index, uint p_view, CountBox p_near, CountBox p_far, uint p_box_count,
		uint p_edge_count, inout uint r_end) {
	const CountViewConstants view = light.views[p_view];
	for (uint first = 0u; first < p_edge_count; first += gl_SubgroupSize) {
		const uint edge = first + gl_SubgroupInvocationID;
		const uint record = p_view * light.record_capacity + min(edge, p_edge_count - 1u);
		const CountEdgeRecord loaded = load_count_record(record);
		uint use = 0u;
		CountBox box = p_near;
		uint i = 0u;
		do { // not twice where there is one box: software drivers run a branch that nobody takes
			use |= find_count_use(view, box, loaded);
			box = p_far;
			++i;
		} while (i < p_box_count);
		const bool is_used = edge < p_edge_count && use != 0u;
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
		const float FAR = 3e38;
		const Bounds all = find_bounds(block, v, -FAR, FAR);
		if (all.least.x <= all.greatest.x) {
			// Near and far ones, as they lie about the middle.
			const float middle = 0.5 * (all.least.z + all.greatest.z);
			Bounds near = find_bounds(block, v, middle, FAR);
			Bounds far = find_bounds(block, v, -FAR, middle);
			const bool is_one =
					near.least.x > near.greatest.x || far.least.x > far.greatest.x;
			near = is_one ? all : near;
			far = is_one ? all : far;
			const uint edge_count = find_total(uint(EDGE_COUNT_TOTAL_RECORDS) + v);
			is_over = is_over || edge_count > light.record_capacity ||
					find_total(uint(EDGE_COUNT_TOTAL_FRAGMENTS) + v) > light.fragment_capacity;
			list_view(block_index, v, make_count_box(light.views[v], near.least, near.greatest),
					make_count_box(light.views[v], far.least, far.greatest), is_one ? 1u : 2u,
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
